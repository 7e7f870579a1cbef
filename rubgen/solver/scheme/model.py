"""Build the constants of a run, and its first state."""

import numpy as np

from rubgen.arrays import FloatArray, frozen
from rubgen.contact.clearance_kernels import LARGEST_TIP_SHIFT, NEAREST_SHARE
from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.geometry import blade_tips, casing_surface, unworn, with_zeros
from rubgen.contact.geometry_kernels import Surface, Tips
from rubgen.linalg.blocks import Blocks, aligned, padded, share_width, system_harmonics
from rubgen.linalg.lanes_kernels import TOGETHER
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw
from rubgen.scenario.contact_laws.contact_law import NORMAL_LAWS
from rubgen.solver.scheme.central_difference import compliances, energy_terms, scheme
from rubgen.solver.scheme.energy_kernels import WORKS
from rubgen.solver.scheme.model_kernels import Angles, Laws, Model
from rubgen.solver.scheme.motion_kernels import Motion, MotionBuffer
from rubgen.solver.scheme.speed_part import SpeedPart
from rubgen.solver.scheme.state_kernels import Scratch, State, Waiting
from rubgen.solver.supports.constants import support_of
from rubgen.solver.supports.support_kernels import SUPPORT_WORKS, SupportState

CANDIDATE_MARGIN_SHARE = 5e-5
"""Blades nearer than this share of the tip radius are solved together. A step doubles it where forces act farther."""
CASING_LIMIT_SHARE = 0.025
"""A casing node displaced by more than this share of the tip radius is outside the range of a linear ring. It is 10 mm
at 0.4 m: eight times the preset casing's thickness, seven times its largest regular response."""
TIP_LIMIT_SHARE = 0.025
"""A tip displaced by more than this share of the tip radius (10 mm) is outside the range of a linear beam. The preset's
blades are 150 mm long and 3.9 mm thick at the root. As cantilevers they have the root stress 3 E (h/2) w / L^2 = 0.5
GPa there, the yield stress of good steel. Their tips would draw back by 3 w^2 / (5 L) = 0.4 mm, more than the
clearance; the tips of a linear beam do not."""


def relative_tip_shift(tips: Tips, tip_limit: float) -> float:
    """Return the largest distance of a tip from its position at rest along either axis, in tip radii.

    It is the steady displacement plus `tip_limit` (m), the displacement beyond which a run has diverged.
    """
    return (tip_limit + float(np.abs(tips.static[:2]).max(initial=0.0))) / tips.radius


def bounds_hold(surface: Surface, tip_shift: float, casing_limit: float) -> bool:
    """Return whether the bounds of `clearance_kernels` are valid in every state of a run that has not diverged.

    They are valid if a tip is less than a quarter of its radius from its position at rest, and the radius of the
    deformed surface is nowhere below 0.9 of its mean. Bladed machines are far inside these limits. A Jeffcott rotor,
    whose one "tip" is on the axis, is not. Tests: tests/solver/scheme/test_screening.py.

    - tip_shift: from `relative_tip_shift`.
    - casing_limit: largest displacement of the casing, m.
    """
    narrowest = surface.mean_radius - float(np.abs(surface.amplitude).sum()) - surface.inset - casing_limit
    return tip_shift < LARGEST_TIP_SHIFT and narrowest > NEAREST_SHARE * surface.mean_radius


def build_model(
    system: SpinningSystem,
    contact: ContactLaw,
    blocks: Blocks,
    steps: int,
    *,
    start_angle: float = 0.0,
    screen: bool = True,
) -> Model:
    """Build the constants of a run of `steps` equal steps a turn.

    - system, contact: the system at its speed, and the contact law.
    - blocks: blocks of the system's matrices.
    - start_angle: theta at the beginning of each turn, rad.
    - screen: True skips blades that bounds show to be far from the casing. False evaluates every blade's gap in every
      step. The result is the same. Where `bounds_hold` is False, every gap is evaluated.
    """
    dt = 2 * np.pi / system.speed / steps
    surface, tips = casing_surface(system, contact), blade_tips(system)
    limits = CASING_LIMIT_SHARE * system.tip_radius, TIP_LIMIT_SHARE * system.tip_radius
    tip_shift = relative_tip_shift(tips, limits[1])
    regards_rate = contact.restitution > 0 or contact.normal.REGARDS_RATE
    laws = Laws(
        speed=float(system.speed),
        dt=float(dt),
        friction=contact.friction,
        restitution=contact.restitution,
        normal=np.array([NORMAL_LAWS.index(type(contact.normal)), *contact.normal.numbers(dt)], dtype=np.float64),
        regards_rate=regards_rate,
        margin=CANDIDATE_MARGIN_SHARE * system.tip_radius,
        casing_limit=limits[0],
        tip_limit=limits[1],
        tip_shift=tip_shift,
        lasting=regards_rate or contact.liner is not None,
        screen=screen and bounds_hold(surface, tip_shift, limits[0]),
    )
    theta = start_angle + 2 * np.pi * (np.arange(steps + 1) % steps) / steps  # the last step is the first exactly
    tip_compliance, casing_compliance = compliances(system, dt)
    return frozen(
        Model(
            surface=surface,
            tips=tips,
            laws=laws,
            angles=angle_tables(system, np.append(theta, theta[-2])),
            scheme=scheme(system.M, system.C, system.K, system.force, dt, blocks),
            harmonics=system_harmonics(blocks, system.n_blades),
            tip_compliance=tip_compliance,
            casing_compliance=casing_compliance,
            support=support_of(system, blocks, dt),
            energy=energy_terms(system, blocks),
        )
    )


def speed_part(system: SpinningSystem, blocks: Blocks, dt: float) -> SpeedPart:
    """Build the fields of a model that depend on the speed. `system` is the same system at another speed; `dt` in s."""
    return frozen(
        SpeedPart(
            blade_tips(system),
            scheme(system.M, system.C, system.K, system.force, dt, blocks),
            *compliances(system, dt),
            support_of(system, blocks, dt),
            energy_terms(system, blocks, zeros=True),
        )
    )


def at_speed(model: Model, part: SpeedPart, speed: float, angles: Angles) -> Model:
    """Return the model at another speed, with the same time step. It is screened only if `model` is.

    - part: made by `speed_part` at that speed with the time step of `model`.
    - speed: in rad/s.
    - angles: tables of the steps to make.
    """
    tip_shift = relative_tip_shift(part.tips, model.laws.tip_limit)
    screen = model.laws.screen and bounds_hold(model.surface, tip_shift, model.laws.casing_limit)
    laws = model.laws._replace(speed=speed, tip_shift=tip_shift, screen=screen)
    return model._replace(laws=laws, angles=angles, **part._asdict())


def angle_tables(system: SpinningSystem, theta: FloatArray, section: float = 0.0) -> Angles:
    """Tabulate cosine and sine of theta, and of order (theta - phase) of the surface's harmonics, at steps of a turn.

    The steps may be a part of a turn. `theta` (steps + 2,) are the angles of steps 0, ..., steps and -1 in rad.
    `section` is the time from step 0 to theta = 0 mod 2 pi, in steps.
    """
    orders = np.multiply.outer(theta, system.surface.order) - system.surface.order * system.surface.phase
    return frozen(Angles(theta, np.cos(theta), np.sin(theta), np.cos(orders), np.sin(orders), section))


def new_state(model: Model) -> State:
    """Return a state at rest: undeformed and unworn, with all works zero. Gaps of earlier steps are NaN, unknown."""
    return State(
        buffer=MotionBuffer(*(aligned(np.zeros((3, *each.shape))) for each in new_motion(model))),
        contact=new_contact_work(len(model.tip_compliance), len(model.casing_compliance)),
        support=SupportState(np.zeros((2, 2)), np.zeros((2, 2)), np.zeros((3, 2)), np.zeros(SUPPORT_WORKS)),
        wear=unworn(model.surface.liner),
        works=np.zeros(WORKS),
        scratch=_scratch(model),
    )


def new_motion(model: Model) -> Motion:
    """Return a motion of zeros, of the model's size."""
    (blades, width), numbers = model.harmonics.basis.shape, model.scheme.constant.size
    n = 3 * blades + model.harmonics.rest.size
    return Motion(aligned(np.zeros(numbers)), aligned(np.zeros((2, width))), aligned(np.zeros(n)))


def _scratch(model: Model) -> Scratch:
    (blades, width), numbers = model.harmonics.basis.shape, model.scheme.constant.size
    n = 3 * blades + model.harmonics.rest.size
    return Scratch(
        new_motion(model), aligned(np.zeros(numbers)), aligned(np.zeros(numbers)),
        aligned(np.zeros((3, share_width(blades)))), aligned(np.zeros(n)), aligned(np.zeros((3, width))),
        Waiting(*aligned(np.zeros((2, TOGETHER, numbers))), *np.zeros((2, TOGETHER))),
    )  # fmt: skip


def new_contact_work(tip_coordinates: int, c: int) -> ContactWork:
    """Allocate the arrays of the contact step for `tip_coordinates` = 3 n_blades, and `c` casing modes.

    The gaps of earlier steps are NaN, unknown.
    """
    m = tip_coordinates // 3
    return ContactWork(
        casing=with_zeros(np.zeros(c)), bounds=np.full(padded(m), np.inf), psi=np.zeros(m), gap=np.zeros(m),
        tangent=np.zeros((m, 2)), step_gaps=np.full((3, m), np.nan), blade=np.zeros(m, dtype=np.int64), lam=np.zeros(m),
        b=np.zeros(m), W=np.zeros((m, m)), normal_tip=np.zeros((m, 3)), full_tip=np.zeros((m, 3)),
        normal_casing=np.zeros((m, c)), full_casing=np.zeros((m, c)), slip=np.zeros((m, 2)), sliding=np.zeros(m),
        casing_response=np.zeros((m, c)), ends=np.zeros(8),
        rows=np.zeros((2, c)), square=np.zeros((m, m)), tableau=np.zeros((m, 2 * m + 2)),
        basis=np.zeros(m, dtype=np.int64),
    )  # fmt: skip
