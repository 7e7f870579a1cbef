"""Names of files and folders with spaces, other scripts and signs of URLs; and URLs where only a path can stand."""

import json
import shutil
from pathlib import Path

import pyarrow.parquet as pq
import pytest

SAMPLE = Path(__file__).parents[2] / "datasets" / "sample"
URL = "s3://bucket/place"
HARD = "it's Größe 日本 a%20b #1?x=2 {run} [0-9] *"
LOCAL = {
    "export": ["export", str(SAMPLE), "--format", "csv", "--out", URL],
    "merge": ["merge", str(SAMPLE), str(SAMPLE), "--out", URL],
    "resense": ["resense", str(SAMPLE), "--sensors", "rig", "--out", URL],
    "features": ["features", str(SAMPLE), "--out", URL],
    "baseline": ["baseline", str(SAMPLE), "--out", URL],
    "figure": ["figure", "overview", str(SAMPLE), "--out", f"{URL}.png"],
    "report": ["report", str(SAMPLE), "--out", f"{URL}.html"],
    "plan": ["plan", "--out", f"{URL}.png"],
    "simulate": ["simulate", "--out", f"{URL}.mcap"],
    "regenerate": ["regenerate", str(SAMPLE), "run-000000", "--out", f"{URL}.mcap"],
    "predictions": ["browse", str(SAMPLE), "--serve", "--predictions", f"{URL}.csv"],
    "save": ["replay", str(SAMPLE), "--save", f"{URL}.rrd"],
    "gif": ["replay", str(SAMPLE), "--gif", f"{URL}.gif"],
    "png": ["replay", str(SAMPLE), "--png", f"{URL}.png"],
    "foxglove": ["replay", str(SAMPLE), "--foxglove", f"{URL}.json"],
}


@pytest.mark.parametrize("words", LOCAL.values(), ids=LOCAL.keys())
def test_a_url_where_only_a_path_can_stand_is_refused_and_makes_no_folder(run, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    code, output, errors = run(*words)
    assert (code, output) == (2, "")
    assert errors == f"rubgen: {words[-2]} {words[-1]}: is a URL; give a path on this computer\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("words", [["init", "recipe", URL], ["replay", URL, "--web"], ["figure", "orbit", URL]])
def test_a_url_in_the_place_of_a_file_is_named_alone(run, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    code, _, errors = run(*words, *(["--out", "x.png"] if words[0] == "figure" else []))
    assert (code, errors) == (2, f"rubgen: {URL}: is a URL; give a path on this computer\n")
    assert list(tmp_path.iterdir()) == []


@pytest.fixture(scope="module")
def named(tmp_path_factory):
    """The sample in a folder with a name of every kind, and beside it a folder of such a name for results."""
    folder = tmp_path_factory.mktemp("names")
    (folder / f"to {HARD}").mkdir()
    return shutil.copytree(SAMPLE, folder / HARD), folder / f"to {HARD}"


def test_commands_read_a_set_whatever_its_name(run, named):
    directory, _ = named
    assert run("verify", str(directory)) == (0, f"{directory}: nothing wrong\n", "")
    code, output, errors = run("info", str(directory), "--json")
    assert (code, errors, json.loads(output)["status"]) == (0, "", {"ok": 4})


def test_commands_write_to_a_folder_whatever_its_name(run, named):
    directory, to = named
    code, output, _ = run(
        "export", str(directory), "--format", "ts", "--channels", "proximity_x", "--out", str(to / "x")
    )
    assert (code, output.startswith(f"{to / 'x'}: 4 runs in 1 file of ts")) == (0, True)
    words = ["features", str(directory), "--channels", "proximity_x", "--set", "time", "--workers", "1"]
    assert run(*words, "--out", str(to / "f.parquet"))[0] == 0
    assert pq.read_table(to / "f.parquet")["run_id"].to_pylist() == [f"run-{i:06d}" for i in range(4)]
    assert run("figure", "waveform", str(directory), "run-000001", "--out", str(to / "w.svg"))[0] == 0
    assert (to / "w.svg").read_text(encoding="utf-8").rstrip().endswith("</svg>")
    assert run("init", "sensors", str(to / "mine.toml"))[0] == 0
    assert {path.name for path in to.iterdir()} == {"x", "f.parquet", "w.svg", "mine.toml", "sensor-set.schema.json"}
