"""The results that studies keep: made once, made again after a cut or a change of code, by one process at a time."""

from contextlib import contextmanager

import numpy as np
import pytest

from rubgen import progress
from rubgen.errors import UserError
from rubgen.progress import count
from validation import piece as piece_module
from validation.markdown import table
from validation.piece import PACKAGE, Piece, physics
from validation.rows import read_rows, replace_rows, write_rows
from validation.store import Store


def squares(n):
    return {"squares": np.arange(n) ** 2}


def test_pieces_are_made_once_and_again_after_a_cut(tmp_path):
    store, pieces, told = Store(tmp_path), [Piece(squares, (n,)) for n in (3, 4)], []
    with store.claimed():
        assert store.compute(pieces, 1, lambda *done: told.append(done)) == 2
    assert told == [(0, 2), (1, 2), (2, 2)]
    again = Store(tmp_path)
    with again.claimed():
        assert again.compute([*pieces, Piece(squares, (5,))], 1) == 1
    np.testing.assert_array_equal(again(pieces[1])["squares"], [0, 1, 4, 9])
    path = tmp_path / "pieces" / f"{pieces[0].key}.npz"
    path.write_bytes(path.read_bytes()[:50])
    cut = Store(tmp_path)
    assert [cut.holds(piece) for piece in pieces] == [False, True]


def test_an_interruption_keeps_what_is_finished(tmp_path):
    def stop(done, _every):
        if done == 1:
            raise KeyboardInterrupt

    pieces, store = [Piece(squares, (n,)) for n in (3, 4)], Store(tmp_path)
    with pytest.raises(KeyboardInterrupt), store.claimed():
        store.compute(pieces, 1, stop)
    assert sum(Store(tmp_path).holds(piece) for piece in pieces) == 1


def test_two_at_once_are_refused(tmp_path):
    with (
        Store(tmp_path).claimed(),
        pytest.raises(UserError, match="another rubgen works there"),
        Store(tmp_path).claimed(),
    ):
        pass


def test_a_piece_of_other_code_is_made_again(tmp_path, monkeypatch):
    store, piece = Store(tmp_path), Piece(squares, (3,))
    with store.claimed():
        store.compute([piece], 1)
    monkeypatch.setattr(piece_module, "physics", lambda *_: "other")
    assert not store.holds(Piece(squares, (3,)))


def test_comments_and_plots_are_no_other_code(tmp_path):
    source = tmp_path / "solver" / "scheme" / "step.py"
    plot = tmp_path / "viz" / "plot.py"
    for path in (source, plot):
        path.parent.mkdir(parents=True)
        path.write_text("b = 1\n", encoding="utf-8")
    digests = []
    for text in ("a = 1\n", "a  =  1  # one\n", "a = 2\n"):
        source.write_text(text, encoding="utf-8")
        digests.append(physics.__wrapped__(tmp_path))
    plot.write_text("b = 2\n", encoding="utf-8")
    assert digests[0] == digests[1] != digests[2] == physics.__wrapped__(tmp_path)


def test_the_code_between_a_machine_and_its_labels_is_read():
    """The hash of no code at all would never notice a change."""
    assert (PACKAGE / "solver" / "integrate.py").exists()
    assert physics(PACKAGE) != physics(PACKAGE / "no such folder")


def test_rows_take_the_place_of_those_of_their_name(tmp_path):
    path = tmp_path / "below" / "rows.json"
    write_rows(path, [{"name": "a", "x": 1.0}, {"name": "b", "x": float("nan")}, {"name": "c"}])
    replace_rows(path, [{"name": "b", "x": 3}, {"name": "b", "x": 4}], by="name")
    assert read_rows(path) == [{"name": "a", "x": 1.0}, {"name": "b", "x": 3}, {"name": "b", "x": 4}, {"name": "c"}]
    write_rows(path, [{"x": [float("nan"), 1]}])
    assert read_rows(path) == [{"x": [None, 1]}]
    assert read_rows(tmp_path / "none.json") == []


def test_a_table_escapes_what_would_end_a_cell():
    assert table(("a", "b"), [("x|y", "1"), ("short",)], numbers_from=1).splitlines() == [
        "| a | b |",
        "| --- | ---: |",
        r"| x\|y | 1 |",
        "| short |",
    ]


def busy(n):
    """A piece that counts its own parts, as an integration counts turns."""
    for done in range(n):
        count(done, n)
    return squares(n)


def test_progress_is_of_pieces_not_of_their_parts(tmp_path):
    store, told = Store(tmp_path), []

    @contextmanager
    def show(_text, _unit, *, long):
        yield lambda *done: told.append(done)

    token = progress._showing.set(show)
    try:
        with store.claimed(), progress.step("simulate", "pieces"):
            store.compute([Piece(busy, (700,))], 1, count)
    finally:
        progress._showing.reset(token)
    assert told == [(0, 1), (1, 1)]
