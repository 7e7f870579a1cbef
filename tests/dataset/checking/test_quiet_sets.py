"""What a set may unpack to follows from its recipe: quiet signals of any length are read, however small the file."""

import re
from dataclasses import replace

import pyarrow as pa
import pytest

import rubgen
from rubgen.dataset.checking.relabel import relabel
from rubgen.dataset.checking.verify import verify
from rubgen.dataset.rows import asked_bytes
from rubgen.errors import UserError
from rubgen.io.parquet import read as parquet_read
from rubgen.io.parquet.read import read_table, row_groups
from rubgen.io.parquet.write import run_table, write_table
from rubgen.scenario.costs import stored_bytes
from tests.synthetic import make_run

ALLOWED = 400_000


@pytest.fixture
def tight_bounds(monkeypatch):
    """Bounds so low that half a second of signals passes them, like an hour passes the real ones."""
    monkeypatch.setattr(parquet_read, "MOST_BYTES", ALLOWED)
    monkeypatch.setattr(parquet_read, "MOST_TIMES", 0)


@pytest.mark.usefixtures("tight_bounds")
def test_a_set_may_hold_what_its_recipe_asks_for(small_set):
    data = rubgen.open(small_set.directory)
    path = data.layout.root / data.manifest.listed("signals")[0]
    with pytest.raises(UserError, match="would unpack to"):
        read_table(path)
    assert verify(small_set.directory) == []
    assert set(data.signals("run-000000")) == set(data.channels)
    assert not relabel(small_set.directory).differences


@pytest.mark.usefixtures("short_records", "tight_bounds")
def test_a_set_beyond_the_general_bounds_is_made(tmp_path, small_set):
    again = rubgen.generate(small_set.recipe, tmp_path / "again", workers=1)
    assert again.status == small_set.made.status


@pytest.mark.usefixtures("tight_bounds")
def test_more_than_the_recipe_asks_for_is_refused(small_set, tmp_path):
    data = rubgen.open(small_set.directory)
    path = data.layout.root / data.manifest.listed("signals")[0]
    many = pa.concat_tables(list(row_groups(path, 1e9)) * 12)
    write_table([many], many.schema, tmp_path / "many.parquet")
    asked = asked_bytes(data.manifest.identity.recorded())
    with pytest.raises(UserError, match=re.escape("many.parquet: would unpack to")):
        list(row_groups(tmp_path / "many.parquet", asked))


@pytest.mark.parametrize("keep_clean", [False, True])
def test_the_channels_of_a_run_take_what_is_said(keep_clean):
    run = make_run(keep_clean=keep_clean)
    table = run_table(run)
    signals = [field.name for field in table.schema if field.type == pa.list_(pa.float32())]
    channels = sum(4 * len(table[name][0].values) for name in signals)
    longer = replace(run.scenario, signal_seconds=run.scenario.signal_seconds + 1)
    second = 4 * len(signals) * run.scenario.sensing.sample_rate_hz
    assert channels <= stored_bytes(run.scenario)
    assert stored_bytes(longer) - stored_bytes(run.scenario) == pytest.approx(second)
