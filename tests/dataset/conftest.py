"""One small set that really was simulated: short records, made once for all tests of data sets."""

import re
import shutil
import sys
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

import rubgen
from rubgen.cli import main

RECIPE = {
    "name": "small",
    "seed": 3,
    "runs": 4,
    "machine": "zeng2019",
    "vary": {
        "speed_rpm": {"choice": [6000.0, 10000.0]},
        "friction": {"uniform": [0.0, 0.1]},
        "disk_support_stiffness_n_per_m": 2e8,
    },
    "simulation": {"settle_turns": 90, "record_turns": 110},
    "output": {"formats": ["parquet", "mcap"], "signal_seconds": 0.62},
}


@contextmanager
def _short_records():
    """Recipes ask for 500 turns; for tests of files 100 will do."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rubgen.scenario.checks.feasible.MIN_RECORD_TURNS", 100)
        yield


@pytest.fixture
def short_records():
    with _short_records():
        yield


@pytest.fixture(scope="module")
def module_with_short_records():
    with _short_records():
        yield


@pytest.fixture(scope="session")
def small_set(tmp_path_factory):
    """Directory, recipe, and what `generate` returned."""
    directory = tmp_path_factory.mktemp("sets") / "small"
    with _short_records():
        made = rubgen.generate(RECIPE, directory, workers=1)
    return SimpleNamespace(directory=directory, recipe=RECIPE, made=made)


@pytest.fixture
def copied_set(small_set, tmp_path):
    """A copy that a test may damage."""
    return shutil.copytree(small_set.directory, tmp_path / "copy")


@pytest.fixture(scope="session")
def shown_set(tmp_path_factory):
    """Directory of a set of two runs with every format."""
    directory = tmp_path_factory.mktemp("sets") / "shown"
    output = {"formats": ["parquet", "mcap", "rrd"], "signal_seconds": 0.1}
    with _short_records():
        rubgen.generate({**RECIPE, "name": "shown", "runs": 2, "output": output}, directory, workers=1)
    return directory


@pytest.fixture
def copied_shown_set(shown_set, tmp_path):
    """A copy that a test may damage."""
    return shutil.copytree(shown_set, tmp_path / "copy")


ADDRESS = re.compile(r"(\d+) runs? at (rerun\+http://127\.0\.0\.1:\d+)/entry/(\w+)")


@pytest.fixture
def browse(capsys):
    """Calls `rubgen browse`; gives exit code and stderr."""

    def browse(*words):
        with pytest.raises(SystemExit) as ended:
            sys.exit(main(["browse", *map(str, words)]))
        return ended.value.code, capsys.readouterr().err

    return browse


@pytest.fixture
def table_of(browse, monkeypatch, capsys):
    """What the catalog has once everything is served, as a table by run_id. The command ends with code 0."""
    from rerun.catalog import CatalogClient

    def table_of(*words):
        tables = []

        def served(_seconds):
            runs, server, entry = ADDRESS.search(capsys.readouterr().out).groups()
            client = CatalogClient(server)
            table = client.get_dataset(id=entry).segment_table().to_pandas()
            assert len(table) == int(runs)
            tables.append(table)
            raise KeyboardInterrupt

        monkeypatch.setattr("rubgen.cli.commands.browsing.time.sleep", served)
        assert browse(*words, "--serve")[0] == 0
        (table,) = tables
        return table.map(lambda cell: cell[0] if hasattr(cell, "__len__") and not isinstance(cell, str) else cell)

    return table_of
