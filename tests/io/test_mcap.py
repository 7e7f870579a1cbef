import dataclasses
import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import NonSeekingReader, make_reader
from mcap_ros2_support_fast.decoder import DecoderFactory
from pydantic import TypeAdapter
from rerun.chunk import McapReader as RerunReader

from rubgen.io.mcap import check_mcap, read_mcap, write_mcap
from rubgen.io.mcap.messages import message_class, read_sample_block, sample_block, timestamp
from rubgen.labels.to_json import labels_to_json
from rubgen.measurement import measure
from rubgen.measurement.motion import contact_intervals
from rubgen.scenario import Scenario, Sensing
from schemas.make import proto_text

SCHEMA = Path(__file__).parents[2] / "schemas" / "rubgen.v1.proto"


@pytest.fixture(scope="session")
def mcap_file(rub_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("mcap") / "run-000000.mcap"
    write_mcap(rub_run, path)
    return path


def decoded(path):
    """Every message, decoded with nothing but the schema in the file."""
    messages = defaultdict(list)
    with path.open("rb") as stream:
        for schema, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            if schema.encoding == "protobuf":
                pool = descriptor_pool.DescriptorPool()
                for file in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
                    pool.Add(file)
                message_type = message_factory.GetMessageClass(pool.FindMessageTypeByName(schema.name))
                messages[channel.topic].append((message.log_time, message_type.FromString(message.data)))
    return messages


def test_signals_read_back_to_the_bit(rub_run, mcap_file):
    read = read_mcap(mcap_file)
    assert list(read.signals) == list(rub_run.recording.channels)
    for name, channel in rub_run.recording.channels.items():
        assert read.signals[name].tobytes() == channel.values.tobytes()
        assert read.channels[name]["unit"] == channel.unit
        assert float(read.channels[name]["range_max"]) == channel.range_max
    assert read.sample_rate_hz == rub_run.recording.sample_rate_hz
    assert read.once_per_rev.tobytes() == rub_run.recording.once_per_rev.tobytes()
    assert read.clean == {}


def test_outside_reader_with_the_embedded_schema_sees_the_same_samples(rub_run, mcap_file):
    messages = decoded(mcap_file)
    rate = rub_run.recording.sample_rate_hz
    for name, channel in rub_run.recording.channels.items():
        blocks = messages[f"/raw/{name}"]
        assert [len(block.values) for _, block in blocks] == [1024] * 7 + [512]
        assert np.concatenate([block.values for _, block in blocks]).astype(np.float32).tobytes() == (
            channel.values.tobytes()
        )
        for time, block in blocks:
            assert block.timestamp.ToNanoseconds() == time == round(block.first_index / rate * 1e9)


def test_labels_and_scenario_come_back_whole(rub_run, mcap_file):
    read = read_mcap(mcap_file)
    assert read.labels == labels_to_json(rub_run.labels)
    assert TypeAdapter(Scenario).validate_python(read.scenario) == rub_run.scenario
    with mcap_file.open("rb") as stream:
        records = {record.name: record.metadata for record in make_reader(stream).iter_metadata()}
    assert json.loads(records["rubgen.labels"]["motion"]) == "period-k"
    assert json.loads(records["rubgen.scenario"]["operation"])["speed_rpm"] == 10000.0


def test_contacts_and_motion_as_events(rub_run, mcap_file):
    messages = decoded(mcap_file)
    expected = contact_intervals(rub_run.response, rub_run.recording)
    by_start = np.argsort(np.maximum(expected.start, 0.0), kind="stable")
    contacts = [contact for _, contact in messages["/contact"]]
    assert len(contacts) > 100
    assert [contact.blade for contact in contacts] == expected.blade[by_start].tolist()
    assert [contact.start_s for contact in contacts] == expected.start[by_start].tolist()
    assert [contact.impulse_n_s for contact in contacts] == expected.impulse[by_start].tolist()
    ((time, motion),) = messages["/labels/motion"]
    assert (time, motion.motion, motion.motion_casing, motion.period) == (0, "period-k", "period-k", 3)


def test_contact_times_meet_the_contact_force(rub_run):
    """A force in the tap at one step alone stands in the recorded channel at the time that the event has."""
    response, recording = rub_run.response, rub_run.recording
    touches = contact_intervals(response, recording)
    start = touches.start[np.argmin(np.abs(touches.start - 0.2))]
    (row,) = np.flatnonzero(response.events.impulse == touches.impulse[touches.start == start][0])
    force = np.zeros(response.record_turns * response.steps_per_turn)
    force[response.events.start_step[row]] = 1.0 / response.dt  # 1 N s
    struck = dataclasses.replace(response, taps=response.taps | {"contact_force": force})
    channel = measure(struck, Sensing(noise=0.0, keep_clean=True), seconds=0.3, rng=np.random.default_rng(0))
    clean = channel.channels["contact_force"].clean.astype(np.float64)
    assert clean.sum() / 25600 == pytest.approx(1.0, rel=1e-4)
    # The filter is even, so that the mean time of what it gives is that of the impulse.
    assert np.arange(clean.size) @ clean / clean.sum() / 25600 == pytest.approx(start, abs=response.dt / 100)


def test_preview_decoded_by_a_ros_reader_bounds_the_samples(rub_run, mcap_file):
    channel = rub_run.recording.channels["casing_acc_180"]
    with mcap_file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        arrays = list(reader.iter_decoded_messages(topics="/preview/acceleration"))
    (dimension,) = arrays[0].decoded_message.layout.dim
    names = dimension.label.split(", ")
    assert names == arrays[0].channel.metadata["names"].split(", ")
    assert (dimension.size, dimension.stride, arrays[0].channel.metadata["unit"]) == (8, 8, "m/s2")
    low, high = names.index("casing_acc_180.min"), names.index("casing_acc_180.max")
    bins = [channel.values[first : first + 25] for first in range(0, channel.values.size, 25)]
    assert [item.decoded_message.data[low] for item in arrays] == [part.min() for part in bins]
    assert [item.decoded_message.data[high] for item in arrays] == [part.max() for part in bins]
    assert [item.message.log_time for item in arrays[:3]] == [0, round(25 / 25600 * 1e9), round(50 / 25600 * 1e9)]


def test_rerun_plots_the_preview_without_set_up(rub_run, mcap_file):
    """Rerun's own reader turns each quantity into one entity of scalars, a line for each minimum and maximum."""
    values = rub_run.recording.channels["contact_force"].values
    chunks = RerunReader(mcap_file).stream().filter(content="/preview/contact_force").to_chunks()
    batches = [chunk.to_record_batch() for chunk in chunks if not chunk.is_static]
    scalars = np.concatenate([batch.column("Scalars:scalars").to_pylist() for batch in batches])
    assert scalars.shape == (308, 2)
    assert scalars[:, 1].max() == values.max()


def test_block_of_bytes_has_the_wire_bytes_of_a_sample_block():
    values = np.random.default_rng(0).standard_normal(1024).astype(np.float32)
    fields = {"timestamp": timestamp(1_500_000_007), "sample_rate": 25600.0, "first_index": 2048}
    plain = message_class("SampleBlock")(**fields, values=values.tolist()).SerializeToString(deterministic=True)
    fast = sample_block(values, 25600.0, 2048, 1_500_000_007)
    assert fast == plain
    time, rate, first, read = read_sample_block(plain)
    assert (time, rate, first, read.tobytes()) == (1_500_000_007, 25600.0, 2048, values.tobytes())


def test_schema_file_is_the_one_of_the_code():
    assert SCHEMA.read_text(encoding="utf-8") == proto_text()


def test_doctor_finds_nothing(mcap_file):
    doctor = [str(Path(sys.executable).with_name("pymcap-cli")), "doctor", str(mcap_file)]
    done = subprocess.run(doctor, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "error" not in done.stdout.lower().replace("0 error", "").replace("no error", ""), done.stdout


def test_sequential_reader_validates_the_data_section(mcap_file):
    with mcap_file.open("rb") as stream:
        assert sum(1 for _ in NonSeekingReader(stream, validate_crcs=True).iter_messages()) > 1000


def test_same_run_same_bytes(make_synthetic_run, mcap_file, tmp_path):
    write_mcap(make_synthetic_run(), tmp_path / "again.mcap")
    assert (tmp_path / "again.mcap").read_bytes() == mcap_file.read_bytes()
    write_mcap(make_synthetic_run(seed=2), tmp_path / "other.mcap")
    assert (tmp_path / "other.mcap").read_bytes() != mcap_file.read_bytes()


def test_run_without_contact(free_run, tmp_path):
    path = tmp_path / "free.mcap"
    write_mcap(free_run, path)
    assert check_mcap(path) == []
    read = read_mcap(path)
    assert read.contacts["blade"].size == 0
    assert read.labels["rub"] is False
    assert read.labels["contact_force_even_share"] is None
    assert "/contact" not in decoded(path)


def test_clean_channels_are_kept_beside_the_recorded_ones(make_synthetic_run, tmp_path):
    run = make_synthetic_run(keep_clean=True)
    write_mcap(run, tmp_path / "clean.mcap")
    assert check_mcap(tmp_path / "clean.mcap") == []
    read = read_mcap(tmp_path / "clean.mcap")
    for name, channel in run.recording.channels.items():
        assert read.clean[name].tobytes() == channel.clean.tobytes()
    assert read.clean["proximity_x"].tobytes() != read.signals["proximity_x"].tobytes()
