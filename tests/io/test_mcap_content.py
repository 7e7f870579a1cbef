"""Well-formed MCAP files of wrong content, and files of somebody else: one line that names file and topic."""

import json
import os
import re
import tracemalloc

import numpy as np
import pytest
from foreign import Parts, parts_of, write_parts
from mcap.writer import CompressionType, IndexType
from mutations import mutated

from rubgen.dataset.reading.replaying import replay_of_mcap
from rubgen.errors import UserError
from rubgen.io.mcap import check_mcap, read_mcap, write_mcap
from rubgen.io.mcap.messages import message_class, read_sample_block, sample_block

FORCE = "/raw/contact_force"


@pytest.fixture(scope="module")
def good(rub_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("mcap") / "good.mcap"
    write_mcap(rub_run, path)
    return path


def refusal(path):
    """The one line with which a file is refused by every way of reading."""
    with pytest.raises(UserError) as caught:
        read_mcap(path)
    text = str(caught.value)
    with pytest.raises(UserError) as again:
        replay_of_mcap(path)
    assert str(again.value) == text
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    assert len(text) < 600
    problems = check_mcap(path)
    assert problems
    assert not any("\n" in problem for problem in problems)
    return text


def changed_message(record, name, **values):
    """The message of a record with other values."""
    message = message_class(name).FromString(record[2])
    for key, value in values.items():
        field = getattr(message, key)
        if isinstance(value, list):
            del field[:]
            field.extend(value)
        else:
            setattr(message, key, value)
    record[2] = message.SerializeToString(deterministic=True)


def changed_json(parts, name, **values):
    each = parts.attachment(name)
    each[1] = json.dumps({**json.loads(each[1]), **values}).encode()


def changed_block(record, *, rate=None, first=None, values=None):
    time, old_rate, old_first, old = read_sample_block(record[2])
    record[2] = sample_block(
        old if values is None else values, rate or old_rate, old_first if first is None else first, time
    )


def rated(value):
    def change(parts):
        for topic in [each[0] for each in parts.channels if each[0].startswith("/raw/")]:
            for record in parts.of(topic):
                changed_message(record, "SampleBlock", sample_rate=value)

    return change


def sensing(**values):
    return lambda parts: changed_json(
        parts, "scenario.json", sensing={**json.loads(parts.attachment("scenario.json")[1])["sensing"], **values}
    )


def labelled(**values):
    return lambda parts: changed_json(parts, "labels.json", **values)


def facts(**values):
    return lambda parts: parts.channel(FORCE)[3].update(values)


def first_of(topic, name, **values):
    return lambda parts: changed_message(parts.of(topic)[0], name, **values)


def garbage(topic):
    def change(parts):
        parts.of(topic)[0][2] = b"\xff" * 40

    return change


def replaced(name, data):
    def change(parts):
        parts.attachment(name)[1] = data

    return change


def backwards(parts):
    records = parts.of("/contact")
    records[0][1] = records[-1][1]


def twice(parts):
    parts.channels.append([FORCE, "protobuf", parts.channel(FORCE)[2], {}])


def other_schema(parts):
    parts.channel("/contact")[2] = parts.channel("/once_per_rev")[2]


def shorter(parts):
    parts.messages.remove(parts.of(FORCE)[-1])


CHANGES = {
    "labels a list": (replaced("labels.json", b"[1]"), "labels.json is no table"),
    "labels no JSON": (replaced("labels.json", b"{"), "labels.json cannot be read"),
    "labels no text": (replaced("labels.json", b"\xff\xfe\x00"), "labels.json cannot be read"),
    "labels deep": (replaced("labels.json", b"[" * 200_000), "labels.json cannot be read"),
    "labels empty": (replaced("labels.json", b"{}"), r"labels.json is not what rubgen writes \(rub"),
    "label a table": (labelled(period={"a": 1}), r"not what rubgen writes \(period"),
    "label of 5000 digits": (labelled(period=10**4000), r"not what rubgen writes \(period"),
    "label not finite": (labelled(contact_duty=float("inf")), r"not what rubgen writes \(contact_duty"),
    "motion unknown": (labelled(motion="round"), r"not what rubgen writes \(motion"),
    "scenario a list": (replaced("scenario.json", b"[]"), "scenario.json is no table"),
    "scenario empty": (replaced("scenario.json", b"{}"), "of another rubgen"),
    "scenario without end": (
        lambda parts: changed_json(parts, "scenario.json", signal_seconds=1e30), "samples a channel|of another rubgen"
    ),
    "scenario of nothing": (lambda parts: changed_json(parts, "scenario.json", signal_seconds=0), "of another rubgen"),
    "rate of the scenario": (sensing(sample_rate_hz=float("nan")), "of another rubgen"),
    "absurd rate of the scenario": (sensing(sample_rate_hz=1e30), "samples a channel|of another rubgen"),
    "range no number": (facts(range_min="x"), f"metadata of {FORCE} .range_min"),
    "range nan": (facts(range_max="nan"), f"metadata of {FORCE} .range_max"),
    "range empty": (facts(range_min="5", range_max="-5"), "the range is empty"),
    "unit missing": (lambda parts: parts.channel(FORCE)[3].pop("unit"), f"metadata of {FORCE} .unit"),
    "rate 0": (rated(0.0), "sample rate 0 is not the scenario's 25600"),
    "rate negative": (rated(-25600.0), "sample rate -25600 is not"),
    "rate nan": (rated(float("nan")), "sample rate nan is not"),
    "rate 1e30": (rated(1e30), r"sample rate 1e\+30 is not"),
    "gap": (lambda parts: changed_block(parts.of(FORCE)[2], first=5000), "block at sample 5000 does not follow"),
    "overlap": (lambda parts: changed_block(parts.of(FORCE)[2], first=5), "block at sample 5 does not follow"),
    "far block": (lambda parts: changed_block(parts.of(FORCE)[2], first=2**63), "does not follow sample"),
    "samples nan": (
        lambda parts: changed_block(parts.of(FORCE)[2], values=np.full(1024, np.nan, np.float32)), "not finite"
    ),
    "a block missing": (shorter, "differ in length"),
    "no samples": (lambda parts: parts.messages.clear(), "no sample can be read"),
    "garbage in raw": (garbage(FORCE), f"{FORCE}: a block cannot be read"),
    "garbage in contact": (garbage("/contact"), "/contact: a message cannot be read"),
    "garbage in pulses": (garbage("/once_per_rev"), "/once_per_rev: a message cannot be read"),
    "garbage in motion": (garbage("/labels/motion"), "/labels/motion: a message cannot be read"),
    "garbage in frames": (garbage("/motion/frames"), "/motion/frames: a message cannot be read"),
    "garbage in modes": (garbage("/motion/casing_modes"), "/motion/casing_modes: a message cannot be read"),
    "no such blade": (first_of("/contact", "Contact", blade=36), "/contact: there is no blade 36; the machine has 36"),
    "touch nan": (first_of("/contact", "Contact", impulse_n_s=float("nan")), "/contact: impulse_n_s is not finite"),
    "touch before it began": (first_of("/contact", "Contact", duration_s=-1.0), "/contact: an event lies outside"),
    "touch far away": (first_of("/contact", "Contact", start_s=1e30), "/contact: an event lies outside"),
    "pulse far away": (first_of("/once_per_rev", "OncePerRev", time_s=1e300), "/once_per_rev: an event lies outside"),
    "class unknown": (first_of("/labels/motion", "MotionLabel", motion="round"), "no class of motion is called"),
    "tips of other blades": (first_of("/motion/frames", "MotionFrame", tips_m=[0.0] * 9), "not those of 36 blades"),
    "centre of one number": (first_of("/motion/frames", "MotionFrame", centre_m=[0.0]), "/motion/frames: sizes"),
    "casing of other modes": (first_of("/motion/frames", "MotionFrame", casing=[0.0]), "/motion/frames: sizes"),
    "frame nan": (first_of("/motion/frames", "MotionFrame", angle_rad=float("inf")), "angle is not finite"),
    "frame late": (first_of("/motion/frames", "MotionFrame", time_s=1e9), "times do not ascend"),
    "modes without values": (first_of("/motion/casing_modes", "CasingModes", values=[]), "0 values for"),
    "modes without end": (first_of("/motion/casing_modes", "CasingModes", nodes=2**31), "/motion/casing_modes"),
    "backwards": (backwards, "/contact: messages are not in order of time"),
    "a channel twice": (twice, "described twice"),
    "another schema": (other_schema, "/contact carries 'rubgen.v1.OncePerRev'"),
    "an attachment twice": (lambda parts: parts.attachments.append(parts.attachments[0]), "stands there twice"),
}  # fmt: skip


@pytest.mark.parametrize("name", CHANGES)
def test_wrong_content_is_named(name, good, tmp_path):
    change, message = CHANGES[name]
    parts = parts_of(good)
    change(parts)
    write_parts(parts, tmp_path / "wrong.mcap")
    assert re.search(message, refusal(tmp_path / "wrong.mcap"))


def test_the_real_writer_and_none_of_its_changes_is_a_good_file(good, tmp_path):
    write_parts(parts_of(good), tmp_path / "same.mcap")
    assert check_mcap(tmp_path / "same.mcap") == []
    write_parts(parts_of(good), tmp_path / "plain.mcap", use_chunking=False)
    assert check_mcap(tmp_path / "plain.mcap") == []


@pytest.mark.parametrize(
    ("topic", "change"),
    [
        ("/tf", garbage("/tf")),
        ("/preview/acceleration", garbage("/preview/acceleration")),
        ("/preview/acceleration", lambda parts: parts.channel("/preview/acceleration")[3].update(names="a, b")),
        ("/contact", first_of("/contact", "Contact", timestamp=None)),
        ("/else", lambda parts: parts.channels.append(["/else", "json", 1, {}])),
    ],
    ids=["transform", "preview", "names", "time", "another topic"],
)
def test_every_topic_is_decoded_when_a_file_is_checked(topic, change, good, tmp_path):
    parts = parts_of(good)
    if topic == "/contact":
        record = parts.of(topic)[5]
        message = message_class("Contact").FromString(record[2])
        message.timestamp.seconds += 3
        record[2] = message.SerializeToString()
    else:
        change(parts)
    write_parts(parts, tmp_path / "wrong.mcap")
    assert any(topic in problem for problem in check_mcap(tmp_path / "wrong.mcap"))


def test_files_of_somebody_else_are_named(good, tmp_path):
    write_parts(Parts(), tmp_path / "empty.mcap")
    assert "attachment scenario.json is missing" in refusal(tmp_path / "empty.mcap")
    other = Parts(schemas={1: ("Pose", "jsonschema", b"{}")}, channels=[["/pose", "json", 1, {}]])
    other.messages = [[0, 1, b"{}"]]
    write_parts(other, tmp_path / "other.mcap")
    assert "attachment scenario.json is missing" in refusal(tmp_path / "other.mcap")
    write_parts(parts_of(good), tmp_path / "unpacked.mcap", compression=CompressionType.NONE)
    assert check_mcap(tmp_path / "unpacked.mcap") == []


@pytest.mark.parametrize("seed", range(250))
def test_a_mutated_file_is_read_right_or_named(seed, good, rub_run, tmp_path):
    """Every change is found; what is still shown of it are the samples that were recorded."""
    path = tmp_path / "mutated.mcap"
    path.write_bytes(mutated(good.read_bytes(), np.random.default_rng(seed)))
    assert check_mcap(path) != []
    with pytest.raises(UserError, match=r"mutated\.mcap: "):
        read_mcap(path)
    try:
        found = replay_of_mcap(path)
    except UserError:
        refusal(path)
        return
    assert found.remarks
    for name, channel in rub_run.recording.channels.items():
        values = found.replay.recording.channels[name].values
        there = np.isfinite(values)
        assert values[there].tobytes() == channel.values[there].tobytes()


def bomb_of_samples(parts):
    """640 MB of zeros in one channel."""
    block = sample_block(np.zeros(4_000_000, np.float32), 25600.0, 0, 0)
    parts.messages += [[0, 2**40, block]] * 40


@pytest.mark.parametrize(
    ("chunk_size", "message"), [(50_000_000, "unpacks to more than"), (400_000_000, "would unpack to")]
)
def test_a_small_file_that_unpacks_to_gigabytes_is_refused(chunk_size, message, good, tmp_path):
    parts = parts_of(good)
    bomb_of_samples(parts)
    write_parts(parts, tmp_path / "bomb.mcap", chunk_size=chunk_size)
    assert (tmp_path / "bomb.mcap").stat().st_size < 1_000_000
    del parts
    tracemalloc.start()
    try:
        with pytest.raises(UserError, match=message):
            read_mcap(tmp_path / "bomb.mcap")
        assert tracemalloc.get_traced_memory()[1] < 450_000_000
    finally:
        tracemalloc.stop()


def test_a_small_file_of_countless_messages_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("rubgen.io.mcap.content.MOST_MESSAGES", 20_000)
    parts = Parts(schemas={1: ("Pose", "jsonschema", b"{}")}, channels=[["/pose", "json", 1, {}]])
    parts.messages = [[0, 0, b""]] * 21_000
    write_parts(parts, tmp_path / "bomb.mcap", index_types=IndexType.NONE)
    assert (tmp_path / "bomb.mcap").stat().st_size < 20_000
    assert "has more than 20,000 messages" in refusal(tmp_path / "bomb.mcap")


def test_pipes_folders_and_devices_are_not_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe.mcap")
    assert "is a pipe" in refusal(tmp_path / "pipe.mcap")
    assert "is a folder" in refusal(tmp_path)
    assert "is a pipe, a socket or a device" in refusal(type(tmp_path)("/dev/zero"))


def test_a_recording_of_one_block_is_a_good_file(make_synthetic_run, tmp_path):
    run = make_synthetic_run(seconds=0.02)
    write_mcap(run, tmp_path / "short.mcap")
    assert check_mcap(tmp_path / "short.mcap") == []
    assert replay_of_mcap(tmp_path / "short.mcap").remarks == ()
