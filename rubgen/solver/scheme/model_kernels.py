"""What a step of the solver takes: laws, angles, states, the model, scratch."""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.geometry_kernels import Surface, Tips
from rubgen.linalg.harmonic_kernels import Harmonics
from rubgen.solver.scheme.free_step_kernels import Scheme
from rubgen.solver.scheme.motion_kernels import Motion
from rubgen.solver.scheme.support_kernels import Support


class Laws(NamedTuple):
    """Numbers of the step: Omega, dt, friction, restitution; lengths in m; screening on or off.

    `margin` is the candidates' least one; a casing node displaced by more than `casing_limit` or a tip by more than
    `tip_limit` in one direction means divergence. Until then each tip is within `spread` tip radii of its place at rest
    in both directions, steady displacement included. `lasting` tells whether gaps that a step leaves are needed again
    where no blade touches: for restitution, and with a liner, which wears before they are asked for.
    """

    speed: float
    dt: float
    friction: float
    restitution: float
    margin: float
    casing_limit: float
    tip_limit: float
    spread: float
    lasting: bool
    screen: bool


class Angles(NamedTuple):
    """Tables over the steps of a turn or of a part of one: rows for steps 0, ..., steps, and at the end for step -1.

    `theta` and its `cosine`, `sine`; `cos_orders`, `sin_orders` (steps + 2, n_harmonics) of order_j (theta - phase_j).
    `section` is the time from step 0 to the section, where theta = 0 mod 2 pi, in steps: within half a step of 0.
    """

    theta: FloatArray
    cosine: FloatArray
    sine: FloatArray
    cos_orders: FloatArray
    sin_orders: FloatArray
    section: float


class State(NamedTuple):
    """q at steps n - 1, n, n + 1, and d or the velocity, each (n,).

    Within a turn, of the tips only those of the blades in contact hold.
    """

    before: FloatArray
    now: FloatArray
    after: FloatArray
    change: FloatArray


class Model(NamedTuple):
    """What does not change from step to step.

    `tip_compliance` (3 blades, 3 blades) and `casing_compliance` (n_casing, n_casing) hold the columns of A^-1.
    """

    surface: Surface
    tips: Tips
    laws: Laws
    angles: Angles
    scheme: Scheme
    harmonics: Harmonics
    tip_compliance: FloatArray
    casing_compliance: FloatArray
    support: Support


class Scratch(NamedTuple):
    """Arrays of a step: a motion to go back to, d in z, a force in z, numbers of one tip coordinate, d or v, tips."""

    free: Motion
    z_change: FloatArray
    z_force: FloatArray
    share: FloatArray
    change: FloatArray
    tips: FloatArray
