"""The protobuf messages of rubgen's MCAP files, defined once. Classes, descriptor and .proto text follow from it."""

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
    TIMESTAMP: descriptor_pb2.FieldDescriptorProto.TYPE_MESSAGE,
}


@dataclass(frozen=True)
class _Field:
    """One field. Its number is its position in the message."""

    type: str
    name: str
    comment: str
    repeated: bool = False


_TIME = _Field(TIMESTAMP, "timestamp", "time after the first sample of the file")
MESSAGES: dict[str, tuple[str, list[_Field]]] = {
    "SampleBlock": (
        "Consecutive samples of one channel; unit and range stand in the metadata of the MCAP channel.",
        [
            _Field(TIMESTAMP, "timestamp", "time of the first sample of the block"),
            _Field("double", "sample_rate", "Hz"),
            _Field("uint64", "first_index", "index of the first sample of the block in the channel"),
            _Field("float", "values", "samples, in the unit of the channel", repeated=True),
        ],
    ),
    "Contact": (
        "One uninterrupted touch of a blade and the casing.",
        [
            _TIME,
            _Field("double", "start_s", "beginning after the first sample, s; negative if it began earlier"),
            _Field("double", "duration_s", "s"),
            _Field("uint32", "blade", "number of the blade, from 0"),
            _Field("double", "angle_rad", "polar angle on the casing, mean weighted by impulse"),
            _Field("double", "impulse_n_s", "normal impulse, N s"),
            _Field("double", "friction_loss_j", "work of friction, J, <= 0"),
            _Field("double", "normal_loss_j", "work lost along the normal, J, <= 0"),
        ],
    ),
    "MotionLabel": (
        "Class of the motion from this time on.",
        [
            _TIME,
            _Field("string", "motion", "of the system: the less regular of blisk and casing"),
            _Field("string", "motion_blisk", ""),
            _Field("string", "motion_casing", ""),
            _Field("uint32", "period", "turns after which the motion repeats; 0 where it does not"),
        ],
    ),
    "BladePassage": (
        "A blade passes a timing probe.",
        [
            _TIME,
            _Field("double", "time_s", "time after the first sample as the probe gives it, s"),
            _Field("uint32", "blade", "number of the blade, from 0"),
            _Field("double", "true_displacement_m", "of the blade's tip along the rotation at that time, known, m"),
        ],
    ),
    "MotionFrame": (
        "The machine at one moment; the blisk in its turning frame.",
        [
            _TIME,
            _Field("double", "time_s", "time after the first sample, s"),
            _Field("double", "angle_rad", "of the blisk, in [0, 2 pi)"),
            _Field("float", "centre_m", "displacement of the disk centre, x and y", repeated=True),
            _Field(
                "float", "tips_m", "radial, tangential, axial displacement of each blade's tip in turn", repeated=True
            ),
            _Field("float", "casing", "amplitudes of the casing's modes", repeated=True),
            _Field("uint32", "dense", "1 about the hardest touch, 0 where a turn or more lies between frames"),
        ],
    ),
    "CasingModes": (
        "Shapes of the casing's modes at nodes at equal steps of polar angle from 0.",
        [
            _TIME,
            _Field("uint32", "nodes", ""),
            _Field("uint32", "modes", ""),
            _Field("float", "values", "node by node, X and Y of every mode", repeated=True),
        ],
    ),
    "OncePerRev": (
        "The blisk passes angle 0.",
        [_TIME, _Field("double", "time_s", "time after the first sample, s"), _Field("uint64", "turn", "from 0")],
    ),
}


def proto_text() -> str:
    """The messages as a .proto file, as under `schemas/`."""
    lines = ['syntax = "proto3";', "", f"package {PACKAGE};", "", 'import "google/protobuf/timestamp.proto";']
    for name, (comment, fields) in MESSAGES.items():
        lines += ["", f"// {comment}", f"message {name} {{"]
        for number, field in enumerate(fields, start=1):
            kind = f"repeated {field.type}" if field.repeated else field.type
            note = f"  // {field.comment}" if field.comment else ""
            lines.append(f"  {kind} {field.name} = {number};{note}")
        lines.append("}")
    return "\n".join(lines) + "\n"


@cache
def file_descriptor_set() -> bytes:
    """Serialised FileDescriptorSet with every message and its imports, as MCAP embeds it."""
    timestamp, own = _timestamp_file(), _own_file()
    return descriptor_pb2.FileDescriptorSet(file=[timestamp, own]).SerializeToString(deterministic=True)


@cache
def message_class(name: str) -> Any:
    """The generated class of the message of that name."""
    pool = descriptor_pool.DescriptorPool()
    for file in (_timestamp_file(), _own_file()):
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(f"{PACKAGE}.{name}"))


def timestamp(time_ns: int) -> dict[str, int]:
    """A google.protobuf.Timestamp as a keyword argument of a generated class."""
    return {"seconds": time_ns // 10**9, "nanos": time_ns % 10**9}


def sample_block(values: Float32Array, sample_rate_hz: float, first_index: int, time_ns: int) -> bytes:
    """Serialised SampleBlock of `values` (n,).

    The message has the packed floats as one bytes field of the same number. Its wire bytes are the same (a test
    compares them), without a Python object for each sample.

    - sample_rate_hz: of the channel.
    - first_index: index of the first sample in the channel.
    - time_ns: time of the first sample.
    """
    block = _bytes_block()(
        timestamp=timestamp(time_ns),
        sample_rate=sample_rate_hz,
        first_index=first_index,
        values=np.ascontiguousarray(values, dtype="<f4").tobytes(),
    )
    return bytes(block.SerializeToString(deterministic=True))


def read_sample_block(data: bytes) -> tuple[int, float, int, Float32Array]:
    """Time in ns, sample rate in Hz, first index and values of a serialised SampleBlock."""
    block = _bytes_block().FromString(data)
    time_ns = block.timestamp.seconds * 10**9 + block.timestamp.nanos
    return time_ns, block.sample_rate, block.first_index, np.frombuffer(block.values, dtype="<f4")


def _timestamp_file() -> descriptor_pb2.FileDescriptorProto:
    file = descriptor_pb2.FileDescriptorProto()
    timestamp_pb2.DESCRIPTOR.CopyToProto(file)
    return file


def _own_file() -> descriptor_pb2.FileDescriptorProto:
    file = descriptor_pb2.FileDescriptorProto(
        name="rubgen/v1.proto", package=PACKAGE, syntax="proto3", dependency=["google/protobuf/timestamp.proto"]
    )
    for name, (_, fields) in MESSAGES.items():
        _add_message(file, name, fields)
    return file


def _add_message(file: descriptor_pb2.FileDescriptorProto, name: str, fields: list[_Field]) -> None:
    message = file.message_type.add(name=name)
    for number, field in enumerate(fields, start=1):
        proto = message.field.add(name=field.name, number=number, type=TYPES[field.type])
        proto.label = proto.LABEL_REPEATED if field.repeated else proto.LABEL_OPTIONAL
        if field.type == TIMESTAMP:
            proto.type_name = f".{TIMESTAMP}"


@cache
def _bytes_block() -> Any:
    """SampleBlock with its packed floats as one bytes field; never written into a file's schema."""
    fields = [_Field("bytes", "values", "") if field.repeated else field for field in MESSAGES["SampleBlock"][1]]
    file = descriptor_pb2.FileDescriptorProto(
        name="rubgen/bytes.proto",
        package=PACKAGE,
        syntax="proto3",
        dependency=["google/protobuf/timestamp.proto"],
    )
    _add_message(file, "SampleBlock", fields)
    pool = descriptor_pool.DescriptorPool()
    pool.Add(_timestamp_file())
    pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(f"{PACKAGE}.SampleBlock"))
