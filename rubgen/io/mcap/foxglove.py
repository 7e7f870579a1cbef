"""Foxglove's protobuf schema of a moving frame, for Rerun and Foxglove on `/tf`."""

import math
from functools import cache
from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2

PACKAGE = "foxglove"
TRANSFORM = "foxglove.FrameTransform"
GROUND, BLISK = "machine", "blisk"
_DOUBLE = descriptor_pb2.FieldDescriptorProto.TYPE_DOUBLE
_STRING = descriptor_pb2.FieldDescriptorProto.TYPE_STRING
_MESSAGE = descriptor_pb2.FieldDescriptorProto.TYPE_MESSAGE
_FILES: tuple[tuple[str, str, tuple[tuple[str, int, str], ...]], ...] = (
    ("foxglove/Vector3.proto", "Vector3", tuple((axis, _DOUBLE, "") for axis in "xyz")),
    ("foxglove/Quaternion.proto", "Quaternion", tuple((axis, _DOUBLE, "") for axis in "xyzw")),
    (
        "foxglove/FrameTransform.proto",
        "FrameTransform",
        (
            ("timestamp", _MESSAGE, ".google.protobuf.Timestamp"),
            ("parent_frame_id", _STRING, ""),
            ("child_frame_id", _STRING, ""),
            ("translation", _MESSAGE, ".foxglove.Vector3"),
            ("rotation", _MESSAGE, ".foxglove.Quaternion"),
        ),
    ),
)


@cache
def transform_descriptor_set() -> bytes:
    """Serialised FileDescriptorSet of FrameTransform and its parts, as MCAP embeds it."""
    return descriptor_pb2.FileDescriptorSet(file=_files()).SerializeToString(deterministic=True)


def transform(time_ns: int, angle: float, centre: list[float]) -> bytes:
    """The frame `blisk` in the frame `machine`, as a serialised message.

    - time_ns: time in ns.
    - angle: rotation about Z, rad.
    - centre: x and y of its origin in the turned frame, m.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y = centre
    message = _message_class()(
        timestamp={"seconds": time_ns // 10**9, "nanos": time_ns % 10**9},
        parent_frame_id=GROUND,
        child_frame_id=BLISK,
        translation={"x": cosine * x - sine * y, "y": sine * x + cosine * y, "z": 0.0},
        rotation={"x": 0.0, "y": 0.0, "z": math.sin(angle / 2), "w": math.cos(angle / 2)},
    )
    return bytes(message.SerializeToString(deterministic=True))


def read_transform(data: bytes) -> Any:
    """The message from its bytes. Raises protobuf's DecodeError where they are not one."""
    return _message_class().FromString(data)


@cache
def _message_class() -> Any:
    pool = descriptor_pool.DescriptorPool()
    for file in _files():
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(TRANSFORM))


def _files() -> list[descriptor_pb2.FileDescriptorProto]:
    stamp = descriptor_pb2.FileDescriptorProto()
    timestamp_pb2.DESCRIPTOR.CopyToProto(stamp)
    return [stamp, *(_file(*each) for each in _FILES)]


def _file(path: str, name: str, fields: tuple[tuple[str, int, str], ...]) -> descriptor_pb2.FileDescriptorProto:
    """One file with one message. Messages among its fields are imported from their own files."""
    file = descriptor_pb2.FileDescriptorProto(name=path, package=PACKAGE, syntax="proto3")
    message = file.message_type.add(name=name)
    for number, (field, kind, of) in enumerate(fields, start=1):
        added = message.field.add(name=field, number=number, type=kind)
        added.label = descriptor_pb2.FieldDescriptorProto.LABEL_OPTIONAL
        if of:
            added.type_name = of
            own = f"foxglove/{of.rsplit('.', 1)[1]}.proto"
            file.dependency.append(own if of.startswith(".foxglove") else "google/protobuf/timestamp.proto")
    return file
