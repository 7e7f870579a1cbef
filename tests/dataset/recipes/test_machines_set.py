"""A set of four virtual machines in two splits, really made: files, card, columns and runs made again."""

import re

import pandas as pd
import pytest
import yaml

import datasets
import rubgen
from rubgen.dataset.reading.replaying import scenario_of
from rubgen.errors import RubgenWarning
from rubgen.scenario import parse_recipe

RECIPE = {
    "name": "fleet",
    "seed": 2,
    "machine": ["zeng2019", "zeng2019-fitted"],
    "machines": {
        "count": 4,
        "runs_per_machine": 2,
        "critical_speed_rpm": [8000, 11000],
        "vary": {
            "blade_count": 12,
            "disk_support_stiffness_n_per_m": {"log_uniform": [5e7, 3e8]},
            "unbalance_kg_m": 1e-4,
        },
    },
    "splits": {"train": 0.5, "unseen": {"share": 0.5, "machines": {"casing_width_m": 0.2}}},
    "vary": {"speed_rpm": {"choice": [6000, 7000]}, "free_penetration_m": -1e-4},
    "simulation": {"settle_turns": 60, "record_turns": 100},
    "labels": {"lyapunov": False},
    "output": {"formats": ["parquet"], "signal_seconds": 0.2},
}


@pytest.fixture(scope="module")
def made(tmp_path_factory, module_with_short_records):
    directory = tmp_path_factory.mktemp("sets") / "fleet"
    with pytest.warns(RubgenWarning, match="no blade can reach the casing in any of the 8 runs"):
        rubgen.generate(RECIPE, directory, workers=1)
    return directory


def test_the_set_verifies_and_no_machine_is_in_two_splits(made):
    assert rubgen.verify(made) == []
    runs = rubgen.open(made).runs
    assert runs["machine_number"].tolist() == [0, 0, 1, 1, 2, 2, 3, 3]
    assert runs.groupby("machine_number")["machine_id"].nunique().tolist() == [1] * 4
    assert runs["machine_id"].nunique() == 4
    assert runs.groupby("machine_id")["split"].nunique().eq(1).all()
    assert set(runs["split"]) == {"train", "unseen"}
    assert (runs["casing_width_m"] == 0.2).tolist() == (runs["split"] == "unseen").tolist()
    assert (runs["blade_count"] == 12).all()
    assert runs.attrs["units"]["casing_width_m"] == "m"


def test_each_split_has_its_files_and_its_row_in_the_card(made):
    runs = rubgen.open(made).runs
    for split in ("train", "unseen"):
        (path,) = (made / "signals").glob(f"{split}-*.parquet")
        mine = runs[runs["split"] == split]
        assert (
            pd.read_parquet(path, columns=["run_id"])["run_id"].tolist() == mine.index[mine["status"] == "ok"].tolist()
        )
        row = re.search(rf"\| `{split}` \| (\d+) \| (\d+) \| (\d+) \| (\d+) \|", (made / "README.md").read_text())
        ok = mine["status"] == "ok"
        counts = [mine["machine_id"].nunique(), len(mine), ok.sum(), mine[ok]["rub"].sum()]
        assert [int(number) for number in row.groups()] == counts
    head = yaml.safe_load((made / "README.md").read_text().split("---\n", 2)[1])
    files = {each["config_name"]: [part["split"] for part in each["data_files"]] for each in head["configs"]}
    each = {key: ["train", "unseen"] for key in ("signals", "truth", "windows", "sections")}
    assert files == each | {"runs": ["runs"], "sensors": ["runs"]}


def test_hugging_face_loads_the_splits(made, tmp_path):
    loaded = datasets.load_dataset(str(made), cache_dir=str(tmp_path))
    runs = rubgen.open(made).ok
    assert {name: len(part) for name, part in loaded.items()} == runs["split"].value_counts().to_dict()


def test_a_run_is_drawn_again_from_the_manifest(made, monkeypatch):
    """The recorded candidate is taken, without its check; the whole check gives the same."""
    data = rubgen.open(made)
    asked = parse_recipe(RECIPE).scenario(5)
    monkeypatch.setattr("rubgen.solver.candidate.candidate_problem", lambda *_: pytest.fail("was checked"))
    again = scenario_of(data, "run-000005")
    assert again == asked
    assert again.machine_id == data.runs.loc["run-000005", "machine_id"]


def test_a_set_of_virtual_machines_is_browsed_with_what_tells_them_apart(made, table_of, tmp_path):
    """The set has no recordings: those of the two runs that the condition chooses are made again from the manifest."""
    runs = rubgen.open(made).ok
    last = runs[runs["machine_number"] == runs["machine_number"].iloc[-1]]
    answers = pd.DataFrame({"rub": [0] * len(runs)}, index=runs.index)
    answers.to_parquet(tmp_path / "answers.parquet")
    where = f"machine_number = {last['machine_number'].iloc[0]}"
    table = table_of(made, "--where", where, "--predictions", tmp_path / "answers.parquet")
    table = table.set_index("property:run:run_id").loc[list(last.index)]
    for name in ("machine_id", "split", "disk_support_stiffness_n_per_m", "casing_width_m", "speed_rpm"):
        assert list(table[f"property:run:{name}"]) == list(last[name]), name
    assert "property:run:blade_count" not in table  # 12 on all machines
    assert table["property:prediction:rub_right"].all()
    assert table["time:end"].notna().all()
