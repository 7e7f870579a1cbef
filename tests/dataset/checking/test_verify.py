"""Each kind of damage is found and named; a whole set has none."""

import json
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.dataset.checking.channel_check import order_amplitudes
from rubgen.dataset.checking.consistency import label_problems, signal_problems
from rubgen.dataset.files import sha256_of
from rubgen.dataset.reading.recorded import row_signals
from rubgen.errors import UserError
from rubgen.io.parquet.write import write_table
from rubgen.scenario import Sensing
from tests.whole_table import whole_table

DATA = "signals/train-00000.parquet"

SENSING = Sensing()


@pytest.fixture(scope="module")
def rows(small_set):
    """Rows with labels and signals of a run without and one with rub."""
    table = whole_table(small_set.directory)
    rows = {row["rub"]: (row, row_signals(table, i)) for i, row in enumerate(table.to_pylist())}
    assert set(rows) == {True, False}
    return rows


def reseal(directory):
    """Make manifest and digest fit the files again, so that only what they say can be found wrong."""
    path = directory / "manifest.json"
    manifest = json.loads(path.read_text())
    for entry in manifest["files"]:
        file = directory / entry["path"]
        entry["sha256"], entry["bytes"] = sha256_of(file), file.stat().st_size
    path.write_text(json.dumps(manifest))
    (directory / "manifest.json.sha256").write_text(f"{sha256_of(path)}  manifest.json\n")


def test_a_whole_set_has_no_problem(small_set):
    assert rubgen.verify(small_set.directory) == []


@pytest.mark.parametrize("name", [DATA, "runs.parquet", "README.md", "mcap/0000/run-000000.mcap"])
def test_a_flipped_bit_is_found(name, copied_set):
    path = copied_set / name
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    assert f"{name}: its sha256 is not the one in the manifest" in rubgen.verify(copied_set)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("mcap/0000/run-000000.mcap", "mcap/0000/run-000000.mcap: "),
        (DATA, "train-00000.parquet: damaged"),
    ],
)
def test_damage_is_found_even_where_the_manifest_was_made_to_fit(name, message, copied_set):
    path = copied_set / name
    content = bytearray(path.read_bytes())
    for place in range(len(content) // 3, len(content) // 3 + 64):
        content[place] ^= 255
    path.write_bytes(content)
    reseal(copied_set)
    assert any(message in problem for problem in rubgen.verify(copied_set))


@pytest.mark.parametrize("name", [DATA, "mcap/0000/run-000000.mcap"])
def test_a_missing_file_is_found(name, copied_set):
    (copied_set / name).unlink()
    assert f"{name}: listed in the manifest, but not there" in rubgen.verify(copied_set)


def test_a_stranger_is_found(copied_set):
    (copied_set / "mcap/0000/run-000009.mcap").write_bytes(b"x")
    assert rubgen.verify(copied_set) == ["mcap/0000/run-000009.mcap: not listed in the manifest"]


def test_a_changed_manifest_is_refused(copied_set):
    path = copied_set / "manifest.json"
    path.write_text(path.read_text().replace('"seed": 3', '"seed": 4'))
    with pytest.raises(UserError, match=r"manifest.json: its digest is not the one in manifest.json.sha256"):
        rubgen.verify(copied_set)


def test_no_set_is_refused(tmp_path):
    with pytest.raises(UserError, match="no finished data set of rubgen"):
        rubgen.verify(tmp_path)


def test_tables_that_differ_are_found(copied_set):
    table = pq.read_table(copied_set / "runs.parquet")
    row = table.to_pylist()
    row[2]["contact_duty"] += 0.25
    write_table([pa.Table.from_pylist(row, table.schema)], table.schema, copied_set / "runs.parquet")
    reseal(copied_set)
    assert f"run-000002: {DATA} and runs.parquet differ" in rubgen.verify(copied_set)


def test_a_missing_row_is_found(copied_set):
    table = pq.read_table(copied_set / DATA)
    write_table([table.slice(1)], table.schema, copied_set / DATA)
    reseal(copied_set)
    assert "run-000000: is ok, but has no signals" in rubgen.verify(copied_set)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"contact_duty": 1.5}, "contact_duty outside"),
        ({"rub": False}, "rub and contact_duty"),
        ({"contact_zones": 7}, "contact_zones and its centres"),
        ({"blades_touched": 0}, "rub and blades_touched"),
        ({"rub_extent": "none"}, "rub and rub_extent"),
        ({"contact_touches": 1}, "contact_touches and blade_touches"),
        ({"blade_touches": [0] * 36}, "blades_touched and blade_touches"),
        ({"blade_impulses_per_turn_n_s": [0.0] * 36}, "blade_impulses_per_turn_n_s and contact_impulse_per_turn_n_s"),
        ({"motion": "static"}, "motion is not the less regular"),
        ({"motion": "period-1", "period": 2}, " and its period"),
        ({"motion_blisk": "chaotic", "period_blisk": 1}, "_blisk and its period"),
        ({"energy_residual": 1e-3}, "energy_residual"),
        ({"contact_force_dominant_order": 10}, "shares or dominant order of contact_force"),
        ({"blisk_x_even_share": 0.9}, "shares or dominant order of blisk_x"),
    ],
)
def test_labels_that_contradict_each_other_are_found(change, message, rows):
    row, _ = rows[True]
    assert list(label_problems(row)) == []
    assert message in " | ".join(label_problems({**row, **change}))


NOTHING = {"even_share": None, "odd_share": None}


@pytest.mark.parametrize(
    ("orders", "rest", "holds"),
    [
        ([1e-165, 2e-165, *[0.0] * 18], {"dominant_order": 0} | NOTHING, True),  # squares are zero
        ([1e-165, 2e-165, *[0.0] * 18], {"dominant_order": 2} | NOTHING, False),
        ([3.0, 4.0, *[0.0] * 14, *[None] * 4], {"dominant_order": 2} | NOTHING, True),  # above half the step rate
        ([3.0, 4.0, *[0.0] * 14, *[None] * 4], {"dominant_order": 1} | NOTHING, False),
        ([3.0, 4.0, *[0.0] * 18], {"dominant_order": 2, "even_share": 0.64, "odd_share": 0.36}, True),
        ([3.0, 4.0, *[0.0] * 18], {"dominant_order": 2} | NOTHING, False),
    ],
)
def test_shares_are_undefined_where_orders_are(orders, rest, holds, rows):
    row, _ = rows[True]
    changed = {f"blisk_x_{name}": value for name, value in ({"orders": orders} | rest).items()}
    assert ("shares or dominant order of blisk_x" not in list(label_problems({**row, **changed}))) == holds


def test_second_order_needs_contact(rows):
    row, _ = rows[False]
    assert "has_2fr without rub" in list(label_problems({**row, "has_2fr": True}))


def test_a_force_without_rub_is_found(rows):
    row, signals = rows[False]
    _, touched = rows[True]
    assert list(signal_problems(row, signals, SENSING)) == []
    force = signals["contact_force"].copy()
    force[700] += 60
    problems = list(signal_problems(row, {**signals, "contact_force": force}, SENSING))
    assert problems[0].startswith("rub is false, but contact_force reaches ")
    assert touched["contact_force"].max() > 60


@pytest.mark.parametrize(
    "name", ["proximity_x", "support_force_y", "casing_acc_0", "contact_force", "tip_clearance_90"]
)
def test_a_channel_of_wrong_scale_is_found(name, rows):
    row, signals = rows[True]
    assert list(signal_problems(row, signals, SENSING)) == []
    wrong = {**signals, name: (signals[name] * np.float32(0.8)).astype(np.float32)}
    assert any("_orders: order" in problem for problem in signal_problems(row, wrong, SENSING))


def test_pulses_of_another_speed_are_found(rows):
    row, signals = rows[True]
    problems = list(signal_problems({**row, "speed_rpm": row["speed_rpm"] * 1.001}, signals, SENSING))
    assert "once_per_rev_s is not spaced by one turn" in problems


def test_a_channel_that_is_short_or_not_finite_is_found(rows):
    row, signals = rows[True]
    short = {**signals, "proximity_y": signals["proximity_y"][:-1]}
    assert any("channels of different lengths" in problem for problem in signal_problems(row, short, SENSING))
    broken = {**signals, "proximity_y": np.full_like(signals["proximity_y"], np.nan)}
    assert "proximity_y is not finite" in list(signal_problems(row, broken, SENSING))


def test_amplitudes_of_known_orders():
    turns = 0.01234567 * np.arange(8100)
    signal = 5 + 3 * np.cos(2 * np.pi * turns + 0.4) + 0.5 * np.sin(2 * np.pi * 4 * turns)
    amplitudes = order_amplitudes(signal.astype(np.float32), 0.01234567)
    np.testing.assert_allclose(amplitudes, [3, 0, 0, 0.5, 0, 0, 0, 0, 0, 0], atol=5e-3)


def test_recordings_are_listed_by_name_and_their_digests_are_in_a_file_of_their_own(
    make_synthetic_run, short_records, tmp_path, monkeypatch
):
    template = make_synthetic_run(seconds=0.1)
    monkeypatch.setattr("rubgen.pipeline.simulate", lambda scenario: replace(template, scenario=scenario))
    monkeypatch.setattr("rubgen.dataset.making.generate.warm_up", lambda *_: [])
    output = {"formats": ["rrd"], "signal_seconds": 0.1}
    rubgen.generate({"name": "a", "runs": 1, "machine": "zeng2019", "output": output}, tmp_path / "set", workers=1)
    manifest = json.loads((tmp_path / "set/manifest.json").read_text())
    assert manifest["derived"] == ["rrd/0000/run-000000.rrd"]
    digests = json.loads((tmp_path / "set/derived.json").read_text())["files"]
    assert [entry["path"] for entry in digests] == manifest["derived"]
    assert not any("rrd/" in problem for problem in rubgen.verify(tmp_path / "set"))
    path = tmp_path / "set/rrd/0000/run-000000.rrd"
    path.write_bytes(path.read_bytes()[:-2000])
    assert any(problem.startswith("rrd/0000/run-000000.rrd: has ") for problem in rubgen.verify(tmp_path / "set"))
    path.unlink()
    assert "rrd/0000/run-000000.rrd: listed in the manifest, but not there" in rubgen.verify(tmp_path / "set")
