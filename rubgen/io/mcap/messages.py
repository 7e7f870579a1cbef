"""The protobuf messages of rubgen's MCAP files. Classes, descriptors and the .proto file come from this table."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2

from rubgen.measurement.channel import Float32Array

PACKAGE = "rubgen.v1"
TIMESTAMP = "google.protobuf.Timestamp"
TYPES = {
    "double": descriptor_pb2.FieldDescriptorProto.TYPE_DOUBLE,
    "float": descriptor_pb2.FieldDescriptorProto.TYPE_FLOAT,
    "uint64": descriptor_pb2.FieldDescriptorProto.TYPE_UINT64,
    "uint32": descriptor_pb2.FieldDescriptorProto.TYPE_UINT32,
    "string": descriptor_pb2.FieldDescriptorProto.TYPE_STRING,
    "bytes": descriptor_pb2.FieldDescriptorProto.TYPE_BYTES,
}
"""Any other type is a message of a file that is imported."""


@dataclass(frozen=True)
class Field:
    """One field of a message. Its number is its position in the message."""

    type: str
    name: str
    comment: str = ""
    repeated: bool = False


_TIME = Field(TIMESTAMP, "timestamp", "time after the first sample of the file")
MESSAGES: dict[str, tuple[str, list[Field]]] = {
    "SampleBlock": (
        "Consecutive samples of one channel; unit and range stand in the metadata of the MCAP channel.",
        [
            Field(TIMESTAMP, "timestamp", "time of the first sample of the block"),
            Field("double", "sample_rate", "Hz"),
            Field("uint64", "first_index", "index of the first sample of the block in the channel"),
            Field("float", "values", "samples, in the unit of the channel", repeated=True),
        ],
    ),
    "Contact": (
        "One uninterrupted touch of a blade and the casing.",
        [
            _TIME,
            Field("double", "start_s", "beginning after the first sample, s; negative if it began earlier"),
            Field("double", "duration_s", "s"),
            Field("uint32", "blade", "number of the blade, from 0"),
            Field("double", "angle_rad", "polar angle on the casing, mean weighted by impulse"),
            Field("double", "impulse_n_s", "normal impulse, N s"),
            Field("double", "friction_loss_j", "work of friction, J, <= 0"),
            Field("double", "normal_loss_j", "work lost along the normal, J, <= 0"),
        ],
    ),
    "MotionLabel": (
        "Class of the motion from this time on.",
        [
            _TIME,
            Field("string", "motion", "of the system: the less regular of blisk and casing"),
            Field("string", "motion_blisk", ""),
            Field("string", "motion_casing", ""),
            Field("uint32", "period", "turns after which the motion repeats; 0 where it does not"),
        ],
    ),
    "BladePassage": (
        "A blade passes a timing probe.",
        [
            _TIME,
            Field("double", "time_s", "time after the first sample as the probe gives it, s"),
            Field("uint32", "blade", "number of the blade, from 0"),
            Field("double", "true_displacement_m", "of the blade's tip along the rotation at that time, known, m"),
        ],
    ),
    "MotionFrame": (
        "The machine at one moment; the blisk in its turning frame.",
        [
            _TIME,
            Field("double", "time_s", "time after the first sample, s"),
            Field("double", "angle_rad", "of the blisk, in [0, 2 pi)"),
            Field("float", "centre_m", "displacement of the disk centre, x and y", repeated=True),
            Field(
                "float", "tips_m", "radial, tangential, axial displacement of each blade's tip in turn", repeated=True
            ),
            Field("float", "casing", "amplitudes of the casing's modes", repeated=True),
            Field("uint32", "dense", "1 about the hardest touch, 0 where a turn or more lies between frames"),
        ],
    ),
    "CasingModes": (
        "Shapes of the casing's modes at nodes at equal steps of polar angle from 0.",
        [
            _TIME,
            Field("uint32", "nodes", ""),
            Field("uint32", "modes", ""),
            Field("float", "values", "node by node, X and Y of every mode", repeated=True),
        ],
    ),
    "OncePerRev": (
        "The blisk passes angle 0.",
        [_TIME, Field("double", "time_s", "time after the first sample, s"), Field("uint64", "turn", "from 0")],
    ),
}


CONTACT_FIELDS = {
    "blade": "blade", "start_s": "start", "duration_s": "duration", "angle_rad": "angle", "impulse_n_s": "impulse",
    "friction_loss_j": "friction_loss", "normal_loss_j": "normal_loss",
}  # fmt: skip
"""The field of `ContactIntervals` of each field of the message Contact."""


def proto_file(path: str, package: str, messages: dict[str, list[Field]]) -> descriptor_pb2.FileDescriptorProto:
    """Describe a .proto file with the given messages. It imports the files of other messages among their fields.

    - path: name of the file, under which other files import it.
    - package: the protobuf package of the messages.
    - messages: the fields of each message, by its name. They get the numbers 1, 2, ... in their order.
    """
    file = descriptor_pb2.FileDescriptorProto(name=path, package=package, syntax="proto3")
    for name, fields in messages.items():
        message = file.message_type.add(name=name)
        for number, field in enumerate(fields, start=1):
            proto = message.field.add(name=field.name, number=number)
            proto.type = TYPES.get(field.type, proto.TYPE_MESSAGE)
            proto.label = proto.LABEL_REPEATED if field.repeated else proto.LABEL_OPTIONAL
            if field.type not in TYPES:
                proto.type_name = f".{field.type}"
                place = f"{field.type.replace('.', '/')}.proto"
                place = "google/protobuf/timestamp.proto" if field.type == TIMESTAMP else place
                file.dependency.extend([] if place in file.dependency else [place])
    return file


def descriptor_set(files: list[descriptor_pb2.FileDescriptorProto]) -> bytes:
    """Serialise the descriptors of `files`, after the descriptor of Timestamp, as an MCAP schema contains them."""
    return descriptor_pb2.FileDescriptorSet(file=_with_timestamp(files)).SerializeToString(deterministic=True)


def class_of(files: list[descriptor_pb2.FileDescriptorProto], name: str) -> Any:
    """Generate the Python class of the message with the full name `name` (package and message) in these files."""
    pool = descriptor_pool.DescriptorPool()
    for file in _with_timestamp(files):
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))


def _with_timestamp(files: list[descriptor_pb2.FileDescriptorProto]) -> list[descriptor_pb2.FileDescriptorProto]:
    timestamps = descriptor_pb2.FileDescriptorProto()
    timestamp_pb2.DESCRIPTOR.CopyToProto(timestamps)
    return [timestamps, *files]


@cache
def file_descriptor_set() -> bytes:
    """Serialise the descriptors of all messages of rubgen and of their imports, as an MCAP schema contains them."""
    return descriptor_set([_own_file()])


@cache
def message_class(name: str) -> Any:
    """Return the Python class of rubgen's message `name`, such as "Contact"."""
    return class_of([_own_file()], f"{PACKAGE}.{name}")


def timestamp(time_ns: int) -> dict[str, int]:
    """Return the fields of a google.protobuf.Timestamp: whole seconds and the remaining nanoseconds of `time_ns`."""
    return {"seconds": time_ns // 10**9, "nanos": time_ns % 10**9}


def sample_block(values: Float32Array, sample_rate_hz: float, first_index: int, time_ns: int) -> bytes:
    """Serialise a SampleBlock message with samples `values` (n,).

    - sample_rate_hz: samples per second of the channel.
    - first_index: index of the first sample in the channel.
    - time_ns: time of the first sample, in ns from the first sample of the file.

    The packed floats are serialised as one bytes field of the same number. The bytes in the file are the same (a test
    compares them), without a Python object for each sample.
    """
    block = _bytes_block()(
        timestamp=timestamp(time_ns),
        sample_rate=sample_rate_hz,
        first_index=first_index,
        values=np.ascontiguousarray(values, dtype="<f4").tobytes(),
    )
    return bytes(block.SerializeToString(deterministic=True))


def read_sample_block(data: bytes) -> tuple[int, float, int, Float32Array]:
    """Parse a serialised SampleBlock: time in ns, sample rate in Hz, index of the first sample, read-only values (n,).

    Raises protobuf's DecodeError, or ValueError, for other bytes.
    """
    block = _bytes_block().FromString(data)
    time_ns = block.timestamp.seconds * 10**9 + block.timestamp.nanos
    return time_ns, block.sample_rate, block.first_index, np.frombuffer(block.values, dtype="<f4")


def _own_file() -> descriptor_pb2.FileDescriptorProto:
    return proto_file("rubgen/v1.proto", PACKAGE, {name: fields for name, (_, fields) in MESSAGES.items()})


@cache
def _bytes_block() -> Any:
    """SampleBlock whose packed floats are one bytes field. It never enters the schema of a file."""
    fields = [Field("bytes", "values") if field.repeated else field for field in MESSAGES["SampleBlock"][1]]
    return class_of([proto_file("rubgen/bytes.proto", PACKAGE, {"SampleBlock": fields})], f"{PACKAGE}.SampleBlock")
