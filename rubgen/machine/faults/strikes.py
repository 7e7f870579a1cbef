"""Blows on the frame: what a fault that does not move the disk does to sensors."""

from dataclasses import dataclass

from rubgen.arrays import FloatArray


@dataclass(frozen=True, kw_only=True)
class Strikes:
    """Blows on the bearing housing. Each blow is so short that only its impulse counts."""

    turned: FloatArray
    """Angle of the shaft at each (any,), in rad, on the scale of the angles that were asked for."""
    impulse_n_s: FloatArray
    direction_rad: FloatArray
    """Direction of each in the inertial frame, from +X."""
