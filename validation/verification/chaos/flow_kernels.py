"""The Lorenz system by the classical Runge-Kutta method."""

from __future__ import annotations

from rubgen.arrays import FloatArray
from rubgen.jit import allocation_free_kernel


@allocation_free_kernel
def lorenz(x: float, y: float, z: float) -> tuple[float, float, float]:
    """The derivatives for sigma = 10, rho = 28, beta = 8/3."""
    return 10.0 * (y - x), x * (28.0 - z) - y, x * y - 8.0 / 3.0 * z


@allocation_free_kernel
def lorenz_steps(state: FloatArray, dt: float, steps: int) -> None:
    """Advance `state` (3,) by so many steps."""
    x, y, z = state[0], state[1], state[2]
    for _ in range(steps):
        a = lorenz(x, y, z)
        b = lorenz(x + 0.5 * dt * a[0], y + 0.5 * dt * a[1], z + 0.5 * dt * a[2])
        c = lorenz(x + 0.5 * dt * b[0], y + 0.5 * dt * b[1], z + 0.5 * dt * b[2])
        d = lorenz(x + dt * c[0], y + dt * c[1], z + dt * c[2])
        x += dt / 6.0 * (a[0] + 2.0 * b[0] + 2.0 * c[0] + d[0])
        y += dt / 6.0 * (a[1] + 2.0 * b[1] + 2.0 * c[1] + d[1])
        z += dt / 6.0 * (a[2] + 2.0 * b[2] + 2.0 * c[2] + d[2])
    state[0], state[1], state[2] = x, y, z
