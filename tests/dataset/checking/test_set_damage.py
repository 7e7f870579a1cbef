"""What happens to files of a set: each is seen, names file and run, opens nothing that is no file of the set."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from test_verify import reseal

import rubgen
from rubgen.dataset.checking.inventory import Kind
from rubgen.dataset.checking.verify import findings
from rubgen.errors import UserError
from rubgen.io.parquet.write import write_table

DATA = "signals/train-00000.parquet"
RUNS = ["run-000000", "run-000001"]


def seal_manifest(directory, change):
    """Change the manifest and make its digest fit."""
    path = directory / "manifest.json"
    manifest = json.loads(path.read_text())
    change(manifest)
    path.write_text(json.dumps(manifest, indent=2, ensure_ascii=False) + "\n")
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    (directory / "manifest.json.sha256").write_text(f"{digest}  manifest.json\n")


def seal_derived(directory):
    from rubgen.dataset.layout import Layout
    from rubgen.dataset.manifest import read_manifest, write_derived

    write_derived(Layout(directory), read_manifest(Layout(directory)).derived)


def test_a_set_of_every_format_has_no_problem(shown_set):
    assert rubgen.verify(shown_set) == []


def test_two_makings_have_one_manifest_and_each_its_digests(shown_set, tmp_path, short_records):
    recipe = json.loads((shown_set / "manifest.json").read_text())["identity"]["recipe"]
    rubgen.generate(recipe, tmp_path / "again", workers=1)
    for name in ("manifest.json", "manifest.json.sha256"):
        assert (tmp_path / "again" / name).read_bytes() == (shown_set / name).read_bytes()
    assert rubgen.verify(tmp_path / "again") == []


def all_files(directory):
    return sorted(path.relative_to(directory).as_posix() for path in directory.rglob("*") if path.is_file())


def test_a_flipped_bit_in_any_file_is_found(shown_set, copied_shown_set):
    rng = np.random.default_rng(1)
    for name in all_files(shown_set):
        good = (shown_set / name).read_bytes()
        places = range(len(good)) if name.endswith(".sha256") else rng.integers(0, len(good), 3)
        for place in places:
            content = bytearray(good)
            content[place] ^= 1 << int(rng.integers(8))
            (copied_shown_set / name).write_bytes(content)
            assert found_in(copied_shown_set, name), (name, place)
        (copied_shown_set / name).write_bytes(good)


def found_in(directory, name):
    try:
        return any(problem.startswith(f"{name}: ") for problem in rubgen.verify(directory))
    except UserError as error:
        return "manifest.json" in str(error) and name.startswith("manifest.json")


def test_a_flipped_bit_in_any_place_of_the_digests_is_found(copied_shown_set):
    from rubgen.dataset.layout import Layout
    from rubgen.dataset.manifest import read_derived

    path = copied_shown_set / "derived.json"
    good = path.read_bytes()
    for place in range(len(good)):
        for bit in range(8):
            content = bytearray(good)
            content[place] ^= 1 << bit
            path.write_bytes(content)
            with pytest.raises(UserError, match=r"derived\.json: damaged"):
                read_derived(Layout(copied_shown_set))


@pytest.mark.parametrize("kind", ["mcap", "rrd"])
def test_swapped_files_are_found_even_where_digests_were_made_to_fit(kind, copied_shown_set):
    first, second = (copied_shown_set / f"{kind}/0000/{run}.{kind}" for run in RUNS)
    first.rename(copied_shown_set / "aside")
    second.rename(first)
    (copied_shown_set / "aside").rename(second)
    assert {f"{kind}/0000/{run}.{kind}" for run in RUNS} <= {p.split(": ")[0] for p in rubgen.verify(copied_shown_set)}
    reseal(copied_shown_set)
    seal_derived(copied_shown_set)
    assert rubgen.verify(copied_shown_set) == [
        f"{kind}/0000/{RUNS[0]}.{kind}: holds {RUNS[1]}",
        f"{kind}/0000/{RUNS[1]}.{kind}: holds {RUNS[0]}",
    ]


@pytest.mark.parametrize("name", ["rrd/0000/run-000001.rrd", DATA, "mcap/0000/run-000000.mcap"])
def test_a_cut_file_is_found_by_its_size(name, copied_shown_set):
    path = copied_shown_set / name
    size = path.stat().st_size
    os.truncate(path, size - 1)
    where = "derived.json" if name.startswith("rrd") else "the manifest"
    assert f"{name}: has {size - 1:,} bytes, {where} says {size:,}" in rubgen.verify(copied_shown_set)


@pytest.mark.parametrize(
    ("name", "column"),
    [(DATA, "proximity_x"), ("runs.parquet", "friction"), ("sections/train-00000.parquet", "section")],
)
def test_a_damaged_row_group_names_its_runs(name, column, copied_shown_set):
    path = copied_shown_set / name
    facts = pq.ParquetFile(path).metadata.row_group(0)
    names = [facts.column(number).path_in_schema.split(".")[0] for number in range(facts.num_columns)]
    chunk = facts.column(names.index(column))
    content = bytearray(path.read_bytes())
    content[(chunk.dictionary_page_offset or chunk.data_page_offset) + chunk.total_compressed_size - 3] ^= 16
    path.write_bytes(content)
    problems = rubgen.verify(copied_shown_set)
    assert problems[0] == f"{name}: its sha256 is not the one in the manifest"
    assert any(
        p.startswith(f"{name}: damaged: row group 0 with run-000000, run-000001, column {column} (") for p in problems
    )


def test_names_of_a_damaged_group_follow_from_its_place(copied_shown_set):
    path = copied_shown_set / DATA
    chunk = pq.ParquetFile(path).metadata.row_group(0).column(0)
    content = bytearray(path.read_bytes())
    content[(chunk.dictionary_page_offset or chunk.data_page_offset) + chunk.total_compressed_size - 1] ^= 255
    path.write_bytes(content)
    assert any("row group 0 with run-000000, run-000001, column run_id" in p for p in rubgen.verify(copied_shown_set))


@pytest.mark.parametrize("name", ["stray.txt", "signals/train-00001.parquet", "rrd/0000/run-000001 (1).rrd", "new/x"])
def test_a_stray_file_is_found(name, copied_shown_set):
    (copied_shown_set / name).parent.mkdir(exist_ok=True)
    (copied_shown_set / name).write_text("x")
    shown = "new" if name == "new/x" else name
    assert rubgen.verify(copied_shown_set) == [f"{shown}: not listed in the manifest"]
    assert {finding.kind for finding in findings(copied_shown_set)} == {Kind.UNLISTED}


def test_what_systems_leave_and_reports_are_no_strays(copied_shown_set):
    for name in (
        ".DS_Store",
        "signals/Thumbs.db",
        "mcap/desktop.ini",
        "mcap/._run-000000.mcap",
        "rrd/._run-000000.rrd",
    ):
        (copied_shown_set / name).write_text("x")
    (copied_shown_set / "lost+found").mkdir()
    rubgen_report(copied_shown_set)
    assert rubgen.verify(copied_shown_set) == []
    assert rubgen.open(copied_shown_set).signals("run-000000")
    (copied_shown_set / "report.html").write_text("<html>somebody's</html>")
    assert rubgen.verify(copied_shown_set) == ["report.html: not listed in the manifest"]


def rubgen_report(directory):
    from rubgen.report.page import write_report

    write_report(directory, directory / "report.html")


@pytest.mark.parametrize("name", [DATA, "README.md", "rrd/0000/run-000000.rrd", "derived.json"])
def test_a_link_out_of_the_set_is_found(name, copied_shown_set, tmp_path):
    (copied_shown_set / name).rename(tmp_path / "outside")
    (copied_shown_set / name).symlink_to(tmp_path / "outside")
    assert f"{name}: is a link out of the set; put the file itself there" in rubgen.verify(copied_shown_set)


def test_a_folder_that_is_a_link_out_of_the_set_is_found(copied_shown_set, tmp_path):
    (copied_shown_set / "mcap").rename(tmp_path / "outside")
    (copied_shown_set / "mcap").symlink_to(tmp_path / "outside")
    found = [p for p in rubgen.verify(copied_shown_set) if "is a link out of the set" in p]
    assert [p.split(": ")[0] for p in found] == [f"mcap/0000/{run}.mcap" for run in RUNS]


@pytest.mark.parametrize(
    "name", [DATA, "runs.parquet", "mcap/0000/run-000000.mcap", "rrd/0000/run-000000.rrd", "derived.json"]
)
def test_a_pipe_does_not_hang(name, copied_shown_set):
    (copied_shown_set / name).unlink()
    os.mkfifo(copied_shown_set / name)
    assert f"{name}: is no regular file" in rubgen.verify(copied_shown_set)


@pytest.mark.parametrize("name", ["signals", "mcap/0000/run-000000.mcap/inner"])
def test_a_folder_in_the_place_of_a_file_is_found(name, copied_shown_set):
    if name == "signals":
        shutil.rmtree(copied_shown_set / "signals")
        (copied_shown_set / "signals").write_text("x")
        assert any(p.startswith(f"{DATA}: ") for p in rubgen.verify(copied_shown_set))
        return
    (copied_shown_set / "mcap/0000/run-000000.mcap").unlink()
    (copied_shown_set / name).mkdir(parents=True)
    assert "mcap/0000/run-000000.mcap: is no regular file" in rubgen.verify(copied_shown_set)


def test_a_file_that_cannot_be_read_is_a_finding(copied_shown_set, monkeypatch):
    real = Path.open

    def refuse(self, *arguments, **options):
        if self.name == "run-000000.mcap":
            raise PermissionError(13, "Permission denied", str(self))
        return real(self, *arguments, **options)

    monkeypatch.setattr(Path, "open", refuse)
    assert rubgen.verify(copied_shown_set) == ["mcap/0000/run-000000.mcap: cannot be read (Permission denied)"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: m.update(format="rubgen data set 2"), "format"),
        (lambda m: m.update(runs=10**9), "runs"),
        (lambda m: (m.update(runs=10**9), m["identity"]["recipe"].update(runs=10**9)), "runs"),
        (lambda m: m["files"][0].update(path="../outside"), "path"),
        (lambda m: m["derived"].append("/etc/passwd"), "derived"),
    ],
)
def test_a_manifest_that_says_what_cannot_be_is_refused(change, message, copied_shown_set):
    seal_manifest(copied_shown_set, change)
    with pytest.raises(UserError, match=rf"manifest\.json: .*{message}"):
        rubgen.verify(copied_shown_set)


def test_more_runs_in_the_manifest_than_there_are_is_found_at_once(copied_shown_set):
    def million(manifest):
        manifest["runs"] = manifest["identity"]["recipe"]["runs"] = 1_000_000
        manifest["status"] = {"ok": 1_000_000}

    seal_manifest(copied_shown_set, million)
    assert "runs.parquet: 2 runs, the manifest has 1000000" in rubgen.verify(copied_shown_set)


def test_the_same_command_points_to_repair_and_not_to_deletion(copied_shown_set, short_records):
    recipe = json.loads((copied_shown_set / "manifest.json").read_text())["identity"]["recipe"]
    (copied_shown_set / "README.md").write_text("edited")
    with pytest.raises(UserError, match=r"README.md: has 6 bytes.*the data files are whole; .*rubgen repair") as told:
        rubgen.generate(recipe, copied_shown_set, workers=1)
    assert "delete" not in str(told.value)
    (copied_shown_set / DATA).write_bytes(b"x")
    with pytest.raises(UserError, match=r"make the set again in a new directory") as told:
        rubgen.generate(recipe, copied_shown_set, workers=1)
    assert "delete" not in str(told.value)
    assert (copied_shown_set / DATA).read_bytes() == b"x"


def test_verify_imports_no_kernel(shown_set):
    code = f"import rubgen, sys; print(rubgen.verify({str(shown_set)!r}), 'numba' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[] False\n"


@pytest.mark.parametrize("column", ["window_impulse_per_turn_n_s", "rub", "casing_acc_0_orders", "speed_rpm"])
def test_values_that_cannot_be_compared_are_findings(column, copied_shown_set):
    for name in ("runs.parquet", DATA):
        table = pq.read_table(copied_shown_set / name)
        rows = [row | {column: None} for row in table.to_pylist()]
        write_table([pa.Table.from_pylist(rows, table.schema)], table.schema, copied_shown_set / name)
    reseal(copied_shown_set)
    problems = rubgen.verify(copied_shown_set)
    assert any(problem.startswith("run-000000: ") for problem in problems)
