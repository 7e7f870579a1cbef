"""Check a system before it is integrated. Each problem is one line."""

import math

import numpy as np

from rubgen.errors import UserError
from rubgen.reduction.model import SpinningSystem
from rubgen.solver.linear.stability import stable_step
from rubgen.units import rev_per_min

LEAST_MASS_SHARE = 1e-13
"""A mass eigenvalue below this share of the largest counts as zero."""


def check_system(system: SpinningSystem) -> None:
    """Check that a system can be integrated. Raises UserError, one line, where it cannot.

    It must turn and have blades, finite matrices, and positive definite masses of blisk and casing. At rest, or at
    speed if all of them draw back, the tips must be inside the casing's narrowest radius. At speed the tips, with their
    centrifugal growth, must be inside its widest radius: between the two radii the blades rub, beyond the widest they
    cannot turn.
    """
    for problem in (_speed_problem, _blade_problem, _number_problem, _mass_problem, _rest_problem, _growth_problem):
        text = problem(system)
        if text:
            raise UserError(text)


def check_step(system: SpinningSystem, steps: int) -> None:
    """Check that `steps` steps a turn are stable: dt < 2 / omega_max. Raises UserError where they are not."""
    turn, longest = 2 * math.pi / system.speed, stable_step(system)
    if turn / steps >= longest:
        raise UserError(
            f"steps = {steps}: a step of {turn / steps:.4g} s is above the stability limit, {longest:.4g} s; "
            f"take at least {math.floor(turn / longest) + 1} steps a turn"
        )


def _speed_problem(system: SpinningSystem) -> str | None:
    if math.isfinite(system.speed) and system.speed > 0:
        return None
    return f"speed = {system.speed:g} rad/s: must be above 0; change the speed"


def _blade_problem(system: SpinningSystem) -> str | None:
    if system.n_blades >= 1:
        return None
    return f"n_blades = {system.n_blades}: contact needs at least one blade; add blades"


def _number_problem(system: SpinningSystem) -> str | None:
    for name in ("M", "C", "K", "force", "tip_static", "casing_modes"):
        if not np.all(np.isfinite(getattr(system, name))):
            return f"{name}: holds a value that is not a finite number; correct the machine or the matrix"
    return None


def _mass_problem(system: SpinningSystem) -> str | None:
    start = system.casing_start
    for name, part in (("blisk", slice(0, start)), ("casing", slice(start, None))):
        masses = np.linalg.eigvalsh((system.M[part, part] + system.M[part, part].T) / 2)
        if not masses[0] > LEAST_MASS_SHARE * masses[-1]:
            kind = "negative" if masses[0] < -LEAST_MASS_SHARE * abs(masses[-1]) else "singular"
            return (
                f"M of the {name} is {kind}, smallest eigenvalue {masses[0]:.3g}: every motion must have a mass above "
                f"0; correct the densities or the matrix"
            )
    return None


def _rest_problem(system: SpinningSystem) -> str | None:
    narrowest = system.surface.mean_radius - float(np.abs(system.surface.amplitude).sum())
    shrunk = float((system.tip_radius + system.tip_static[:, 0]).max())
    if min(system.tip_radius, shrunk) < narrowest:
        return None
    return (
        f"clearance = {narrowest - system.tip_radius:.4g} m: blade tips of radius {system.tip_radius:g} m pass the "
        f"casing at rest, whose narrowest radius is {narrowest:g} m; shorten the blades or widen the casing"
    )


def _growth_problem(system: SpinningSystem) -> str | None:
    grown = _grown_radius(system)
    widest = system.surface.mean_radius + float(np.abs(system.surface.amplitude).sum())
    if grown < widest:
        return None
    return (
        f"speed_rpm = {rev_per_min(system.speed):.6g}: blade tips grow by {grown - system.tip_radius:.3g} m and pass "
        f"the casing everywhere, its widest gap at rest is {widest - system.tip_radius:.3g} m; lower the speed or "
        f"raise the clearance"
    )


def _grown_radius(system: SpinningSystem) -> float:
    """Return the largest radius of a tip at speed, in m."""
    return float(np.hypot(system.tip_radius + system.tip_static[:, 0], system.tip_static[:, 1]).max())
