"""One run, four readers: memory, MCAP, Parquet and Rerun agree to the bit after float32."""

import numpy as np
import pytest
from rerun.chunk import RrdReader

from rubgen.io.columns import SCALARS
from rubgen.io.mcap import read_mcap, write_mcap
from rubgen.io.parquet import read_table, write_parquet
from rubgen.labels.plain import labels_dict
from rubgen.viz.replay import replay_of
from rubgen.viz.rerun import write_rrd
from rubgen.viz.signal_entities import detail_window


@pytest.fixture(scope="module")
def folder(rub_run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("truth")
    write_mcap(rub_run, folder / "run.mcap")
    write_parquet(rub_run, folder / "run.parquet")
    write_rrd(rub_run, folder / "run.rrd")
    return folder


def test_signals_agree_to_the_bit(rub_run, folder):
    mcap, row = read_mcap(folder / "run.mcap").signals, read_table(folder / "run.parquet").to_pylist()[0]
    for name, channel in rub_run.recording.channels.items():
        memory = channel.values
        assert memory.dtype == np.float32
        assert mcap[name].tobytes() == memory.tobytes()
        assert np.array(row[name], dtype=np.float32).tobytes() == memory.tobytes()


def test_rerun_shows_the_same_samples(rub_run, folder):
    window = detail_window(replay_of(rub_run))
    mcap = read_mcap(folder / "run.mcap").signals
    for quantity, group in rub_run.recording.by_quantity().items():
        (chunk,) = [
            chunk
            for chunk in RrdReader(folder / "run.rrd").stream().filter(content=f"/detail/{quantity}").to_chunks()
            if not chunk.is_static
        ]
        shown = np.array(chunk.to_record_batch().column("Scalars:scalars").to_pylist(), dtype=np.float32)
        for column, channel in enumerate(group):
            assert shown[:, column].tobytes() == mcap[channel.name][window].tobytes()


def test_labels_agree(rub_run, folder):
    memory = labels_dict(rub_run.labels)
    row = read_table(folder / "run.parquet").to_pylist()[0]
    assert read_mcap(folder / "run.mcap").labels == memory
    columns = [column.name for column in SCALARS if column.name in memory]
    assert len(columns) > 20
    assert {name: row[name] for name in columns} == {name: memory[name] for name in columns}


def test_pulses_agree(rub_run, folder):
    pulses = rub_run.recording.once_per_rev
    row = read_table(folder / "run.parquet").to_pylist()[0]
    assert read_mcap(folder / "run.mcap").once_per_rev.tobytes() == pulses.tobytes()
    assert np.array(row["once_per_rev_s"]).tobytes() == pulses.tobytes()
