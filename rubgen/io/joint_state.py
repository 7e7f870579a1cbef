"""ROS 2 JointState messages in CDR: the form of named scalars that Rerun and Foxglove plot without set-up."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np

from rubgen.arrays import FloatArray, IntArray

SCHEMA_NAME = "sensor_msgs/msg/JointState"
_RULE = "=" * 80
SCHEMA = f"""std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
{_RULE}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{_RULE}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
""".encode()
_ENCAPSULATION = b"\x00\x01\x00\x00"  # plain CDR, little endian; alignment counts from here


def joint_states(names: Sequence[str], times_ns: IntArray, positions: FloatArray) -> list[bytes]:
    """One CDR message for each row of `positions` (n, len(names)), stamped with `times_ns` (n,).

    All messages have the same layout, so that a template is filled for all of them at once: stamp (8 bytes after the
    encapsulation), empty frame_id, names, positions on a multiple of 8, no velocity, no effort.
    """
    head = bytearray(struct.pack("<iI", 0, 0)) + _string("")
    _align(head, 4)
    head += struct.pack("<I", len(names))
    for name in names:
        _align(head, 4)
        head += _string(name)
    _align(head, 4)
    head += struct.pack("<I", len(names))
    _align(head, 8)
    layout = np.dtype(
        [
            ("encapsulation", "S4"),
            ("stamp", "<u4", (2,)),
            ("head", np.void, len(head) - 8),
            ("position", "<f8", (len(names),)),
            ("velocity_count", "<u4"),
            ("effort_count", "<u4"),
        ]
    )
    messages = np.zeros(len(times_ns), dtype=layout)
    messages["encapsulation"] = _ENCAPSULATION
    messages["stamp"] = np.column_stack([times_ns // 10**9, times_ns % 10**9])
    messages["head"] = np.void(bytes(head[8:]))
    messages["position"] = positions
    return [message.tobytes() for message in messages]


def _string(text: str) -> bytes:
    encoded = text.encode() + b"\0"
    return struct.pack("<I", len(encoded)) + encoded


def _align(buffer: bytearray, size: int) -> None:
    buffer += bytes(-len(buffer) % size)
