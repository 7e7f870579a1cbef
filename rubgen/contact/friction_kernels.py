"""Direction of sliding friction on a blade tip."""

import math

from rubgen.jit import allocation_free_kernel


@allocation_free_kernel
def slip_velocity(
    tip: tuple[float, float, float], casing: tuple[float, float], tangent: tuple[float, float]
) -> tuple[float, float]:
    """Velocity of the tip relative to the casing along the surface's tangent and along e_z, m/s, all inertial."""
    return (tip[0] - casing[0]) * tangent[0] + (tip[1] - casing[1]) * tangent[1], tip[2]


@allocation_free_kernel
def friction_direction(along: float, axial: float) -> tuple[float, float]:
    """-v_rel / |v_rel| in the plane of tangent and e_z; zero without slip."""
    speed = math.sqrt(along * along + axial * axial)
    if speed == 0.0:
        return 0.0, 0.0
    return -along / speed, -axial / speed
