"""The motion of the machine from the messages of an MCAP file."""

import numpy as np

from rubgen.io.mcap.content import McapContent, check_order, rows
from rubgen.io.mcap.records import DamageError
from rubgen.measurement.motion_frames import MotionFrames
from rubgen.scenario import Scenario

FRAMES, MODES = "/motion/frames", "/motion/casing_modes"


def read_frames(content: McapContent, scenario: Scenario) -> MotionFrames | None:
    """The frames; None where the file has none. Raises DamageError where they do not fit each other or the machine."""
    found, shapes = rows(content, FRAMES), rows(content, MODES)
    if not found or not shapes:
        return None
    check_order(content, FRAMES)
    blades, modes = scenario.machine.blades.count, shapes[0]
    sizes = {(len(row.centre_m), len(row.tips_m), len(row.casing)) for row in found}
    if sizes != {(2, 3 * blades, modes.modes)}:
        raise DamageError(f"{FRAMES}: sizes are not those of {blades} blades and {modes.modes} modes of the casing")
    if len(modes.values) != 2 * modes.nodes * modes.modes or not modes.values:
        raise DamageError(f"{MODES}: {len(modes.values)} values for {modes.nodes} nodes and {modes.modes} modes")
    frames = MotionFrames(
        time=np.array([row.time_s for row in found]),
        angle=np.array([row.angle_rad for row in found]),
        centre=np.array([row.centre_m for row in found], dtype=np.float64),
        tips=np.array([row.tips_m for row in found], dtype=np.float64).reshape(len(found), -1, 3),
        casing=np.array([row.casing for row in found], dtype=np.float64),
        dense=np.array([row.dense for row in found], dtype=np.int64),
        casing_modes=np.array(modes.values, dtype=np.float64).reshape(modes.nodes, 2, modes.modes),
    )
    _check_values(frames, scenario.signal_seconds)
    return frames


def _check_values(frames: MotionFrames, seconds: float) -> None:
    for name in MotionFrames.__dataclass_fields__:
        if not np.isfinite(getattr(frames, name)).all():
            raise DamageError(f"{FRAMES}: {name} is not finite")
    time = frames.time
    if (np.diff(time) < 0).any() or time[0] < 0 or time[-1] > seconds:
        raise DamageError(f"{FRAMES}: times do not ascend within the recording of {seconds:g} s")
    if (frames.dense > 1).any():
        raise DamageError(f"{FRAMES}: dense is neither 0 nor 1")
