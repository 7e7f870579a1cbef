"""What the system refuses is said with its own cause; only what happened at the output is said of the output."""

import errno
import os

import pytest

import rubgen
from rubgen.cli.printing import write_file
from rubgen.errors import RubgenError, UserError, write_problems
from rubgen.report import page


def problem(number, path=None):
    return OSError(number, os.strerror(number), path) if path else OSError(number, os.strerror(number))


@pytest.mark.parametrize(
    ("error", "kind", "said"),
    [
        (problem(errno.EACCES, "OUT"), UserError, "OUT: cannot be written (Permission denied); choose another place"),
        (problem(errno.EROFS, "OUT/a/b"), UserError, "OUT/a/b: cannot be written (Read-only file system); choose "),
        (problem(errno.ENOSPC), UserError, "OUT: the disk is full; make room and give the same command again: all"),
        (problem(errno.EDQUOT, "OUT/a"), UserError, "OUT: the disk quota is used up; make room and give the same"),
        (problem(errno.EDQUOT), UserError, "OUT: the disk quota is used up; make room and give the same command"),
        (problem(errno.EACCES, "/recipe.toml"), RubgenError, "/recipe.toml: Permission denied; all is kept: the same"),
        (problem(errno.ENOSPC, "/elsewhere/x"), RubgenError, "/elsewhere/x: No space left on device; all is kept"),
        (problem(errno.EMFILE), RubgenError, "Too many open files; all is kept: the same command makes the rest"),
        (problem(errno.ENOLCK), RubgenError, "No locks available; all is kept"),
        (OSError("no number"), RubgenError, "no number; all is kept"),
    ],
)
def test_only_what_happened_at_the_output_is_said_of_it(tmp_path, error, kind, said):
    out = str(tmp_path / "out")
    if error.filename:
        error.filename = error.filename.replace("OUT", out)
    with pytest.raises(RubgenError) as seen, write_problems(tmp_path / "out", kept="all is kept"):
        raise error
    assert type(seen.value) is kind
    assert str(seen.value).startswith(said.replace("OUT", out))


CAUSES = [
    (problem(errno.EMFILE), RubgenError, "Too many open files"),
    (problem(errno.EACCES, "/font.ttf"), RubgenError, "/font.ttf: Permission denied"),
    (problem(errno.EDQUOT), UserError, "the disk quota is used up"),
    (problem(errno.EIO), UserError, "cannot be written (Input/output error)"),
]


def figure(path):
    write_file("--out", path, lambda part: part.write_bytes(b"drawn"))


def report(path):
    page.write_report(path.parent, path)


@pytest.mark.parametrize(("error", "kind", "said"), CAUSES)
@pytest.mark.parametrize("write", ["figure", "simulate", "report"])
def test_every_file_that_is_written_follows_it(tmp_path, monkeypatch, rub_run, error, kind, said, write):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr(page, "render_report", lambda _: "page")
    monkeypatch.setattr(os, "fsync", fail)
    path = tmp_path / "run.mcap"
    act = {"figure": figure, "simulate": rub_run.save, "report": report}[write]
    with pytest.raises(RubgenError) as seen:
        act(path)
    assert type(seen.value) is kind
    assert said in str(seen.value)
    assert ("run.mcap" in str(seen.value)) == (kind is UserError)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("what", ["folder", "link", "mode", "io"])
def test_an_input_that_cannot_be_read_is_not_said_of_the_output(tmp_path, monkeypatch, what):
    recipe = tmp_path / "recipe.toml"
    if what == "folder":
        recipe.mkdir()
    elif what == "link":
        recipe.symlink_to("gone")
    else:
        recipe.write_text('name = "x"')
        number = errno.EIO if what == "io" else errno.EACCES
        monkeypatch.setattr("pathlib.Path.open", lambda path, *_: (_ for _ in ()).throw(problem(number, str(path))))
    with pytest.raises(UserError, match=r"recipe.toml: (cannot be read|there is no such file).*; ") as seen:
        rubgen.generate(recipe, tmp_path / "out")
    assert "written" not in str(seen.value)
    assert not (tmp_path / "out").exists()
