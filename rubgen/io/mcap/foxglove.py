"""Messages that Rerun and Foxglove show without set-up: a moving frame on `/tf`, and arrays of floats.

The frame is Foxglove's protobuf message. The arrays are ROS 2 Float64MultiArray in CDR: JointState carries a name for
each line, but Rerun opens an empty view for each of its two unused fields.
"""

import math
import struct
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.io.mcap.messages import TIMESTAMP, Field, class_of, descriptor_set, proto_file, timestamp

TRANSFORM = "foxglove.FrameTransform"
GROUND, BLISK = "machine", "blisk"
_FIELDS = {
    "Vector3": [Field("double", axis) for axis in "xyz"],
    "Quaternion": [Field("double", axis) for axis in "xyzw"],
    "FrameTransform": [
        Field(TIMESTAMP, "timestamp"),
        Field("string", "parent_frame_id"),
        Field("string", "child_frame_id"),
        Field("foxglove.Vector3", "translation"),
        Field("foxglove.Quaternion", "rotation"),
    ],
}
_FILES = [proto_file(f"foxglove/{name}.proto", "foxglove", {name: fields}) for name, fields in _FIELDS.items()]
SCHEMA_NAME = "std_msgs/msg/Float64MultiArray"
_RULE = "=" * 80
SCHEMA = f"""std_msgs/MultiArrayLayout layout
float64[] data
{_RULE}
MSG: std_msgs/MultiArrayLayout
std_msgs/MultiArrayDimension[] dim
uint32 data_offset
{_RULE}
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
""".encode()
_ENCAPSULATION = b"\x00\x01\x00\x00"  # plain CDR, little endian; alignment counts from here


@cache
def transform_descriptor_set() -> bytes:
    """Serialise the protobuf descriptors of FrameTransform and of its parts, as an MCAP schema contains them."""
    return descriptor_set(_FILES)


def transform(time_ns: int, angle: float, centre: list[float]) -> bytes:
    """Serialise a FrameTransform message: position and rotation of the frame `blisk` in the inertial frame `machine`.

    - time_ns: time in ns.
    - angle: rotation about Z, rad.
    - centre: x and y of the disk centre in the turning frame, m.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y = centre
    message = _message_class()(
        timestamp=timestamp(time_ns),
        parent_frame_id=GROUND,
        child_frame_id=BLISK,
        translation={"x": cosine * x - sine * y, "y": sine * x + cosine * y, "z": 0.0},
        rotation={"x": 0.0, "y": 0.0, "z": math.sin(angle / 2), "w": math.cos(angle / 2)},
    )
    return bytes(message.SerializeToString(deterministic=True))


def read_transform(data: bytes) -> Any:
    """Parse a serialised FrameTransform. Raises protobuf's DecodeError for other bytes."""
    return _message_class().FromString(data)


@cache
def _message_class() -> Any:
    return class_of(_FILES, TRANSFORM)


def multi_arrays(names: Sequence[str], values: FloatArray) -> list[bytes]:
    """Serialise each row of `values` (n, len(names)) as a Float64MultiArray in CDR.

    The label of the array's only dimension contains the names, with commas between them. All messages have the same
    header, so that all are filled at once.
    """
    count = len(names)
    label = ", ".join(names).encode() + b"\0"
    head = struct.pack("<II", 1, len(label)) + label
    head = _padded(head, 4) + struct.pack("<IIII", count, count, 0, count)  # size, stride, data_offset, length
    head = _ENCAPSULATION + _padded(head, 8)
    layout = np.dtype([("head", np.void, len(head)), ("values", "<f8", (count,))])
    messages = np.zeros(len(values), dtype=layout)
    messages["head"] = np.void(head)
    messages["values"] = values
    return [message.tobytes() for message in messages]


def read_multi_array(data: bytes) -> tuple[list[str], FloatArray]:
    """Parse a message of `multi_arrays` into names and read-only values (len(names),).

    Raises ValueError or struct.error for other bytes.
    """
    if data[: len(_ENCAPSULATION)] != _ENCAPSULATION:
        raise ValueError("no little-endian CDR")
    body = data[len(_ENCAPSULATION) :]
    dimensions, length = struct.unpack_from("<II", body)
    label = body[8 : 8 + length]
    place = 8 + length + -length % 4
    count, stride, offset, values = struct.unpack_from("<IIII", body, place)
    place += 16 + -(place + 16) % 8
    if (dimensions, stride, offset, values) != (1, count, 0, count) or len(body) - place != 8 * count:
        raise ValueError("its sizes contradict each other")
    return label.rstrip(b"\0").decode().split(", "), np.frombuffer(body, "<f8", count, place)


def _padded(data: bytes, size: int) -> bytes:
    return data + bytes(-len(data) % size)
