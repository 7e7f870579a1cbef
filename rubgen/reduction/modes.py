"""Natural modes of a machine at one speed: frequency, nodal diameters, whirl, damping, family."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.linalg import block_diag, eig, eigh
from scipy.optimize import linear_sum_assignment

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.linalg.threads import one_blas_thread
from rubgen.machine import Machine
from rubgen.reduction.reduced import ReducedModel, linearised, lost_masses, reduce
from rubgen.scenario import Reduction
from rubgen.units import rev_per_min

REST = 1e-3
"""Speed in rad/s that stands for rest, where no load of a growing blade is defined."""
SUPPORTS = ("lateral", "lateral", "axial", "tilt", "tilt", "torsion")
LEAST_SHARE = 0.4
"""A mode that has this share of its elastic energy in the springs of the disk support is named after them."""
APART = 10.0
"""Weight of the distance of two roots over their sizes, beside the difference of two shapes, 0 to 1. Roots of one
family differ by a few percent, roots of two families by tens of percent."""


@dataclass(frozen=True, kw_only=True)
class Mode:
    """A natural mode of the damped blisk without contact, described as a wave around the blisk."""

    turning_hz: float
    """Frequency in the turning frame, Hz. Negative where the wave goes against the rotation."""
    inertial_hz: float
    """Frequency in the inertial frame, Hz: turning_hz + n f_r. Negative for backward whirl."""
    nodal_diameters: int
    """n, the number of waves around the blisk."""
    damping_ratio: float
    """-Re s / |s|, in the frame in which the damper stands: inertial for motion on the support, else turning."""
    family: str
    """`lateral`, `tilt`, `axial`, `torsion` for motion on the support, else `blade 1`, `blade 2`, ... by frequency."""
    whirl: str
    """`forward` or `backward` in the inertial frame; empty at rest and for a wave that cannot travel: n = 0 or half the
    blades."""


@dataclass(frozen=True, kw_only=True)
class _Named:
    """Roots s of the damped blisk, one of each conjugate pair, and what each mode is called."""

    roots: ComplexArray
    """The roots (modes,), 1/s."""
    shapes: ComplexArray
    """Motion of tips and disk centre (3 blades + 2, modes)."""
    waves: list[int]
    """Nodal diameters of each mode."""
    families: list[str]
    """As `Mode.family`."""


def blisk_modes(model: ReducedModel, speed: float) -> list[Mode]:
    """Compute the modes of the damped blisk at `speed` in rad/s, 0 or more, sorted by the size |s| of their roots s.

    The quadratic problem M s^2 + C s + K = 0 of the turning frame is solved. Two conjugate roots give one mode. In a
    mode with n nodal diameters blade k at the angle phi_k on the disk has the phase -n phi_k, so the wave turns with
    the frequency of the turning frame over n. In the inertial frame it has the frequency omega + n Omega. A family
    counts the modes of one n and direction. Where blades differ or are lost, modes mix waves: each mode then has n,
    direction and family of the mode of the even blisk that it resembles, and no two modes resemble the same one. Uneven
    springs and dampers count with their mean, and laws of the support are left out.
    """
    named = _named_by_waves(model, speed) if _even(model.machine) else _named_by_likeness(model, speed)
    found = sorted(zip(named.roots, named.waves, named.families, strict=True), key=lambda each: abs(each[0]))
    modes = []
    for root, wave, family in found:
        on_support = family in SUPPORTS
        travels = 0 < 2 * wave < model.machine.blades.count or (on_support and wave == 1)
        seen = float(root.imag + wave * speed)
        modes.append(
            Mode(
                turning_hz=float(root.imag) / (2 * np.pi),
                inertial_hz=seen / (2 * np.pi),
                nodal_diameters=wave,
                damping_ratio=float(-root.real / np.hypot(root.real, seen if on_support else root.imag)),
                family=family,
                whirl=("forward" if seen > 0 else "backward") if travels and speed else "",
            )
        )
    return modes


def _even(machine: Machine) -> bool:
    """Whether all blades are equal."""
    return not (any(machine.blades.stiffness_deviations) or machine.lost_blades or lost_masses(machine))


def _named_by_waves(model: ReducedModel, speed: float) -> _Named:
    """Name the modes of an even blisk by their waves and frequencies."""
    roots, shapes = _roots(model, speed)
    blades = model.machine.blades.count
    chosen, waves = _one_of_each_pair(roots, shapes, blades)
    order = np.argsort(np.abs(roots[chosen]), kind="stable")
    chosen, waves = np.array(chosen)[order].tolist(), np.array(waves)[order].tolist()
    kinds = _support_kinds(model, shapes[:, chosen])
    if blades == 2:
        roots[chosen] = _seen_from_the_shaft(model, roots[chosen], shapes[:, chosen], kinds)
    counts: dict[tuple[int, bool], int] = {}
    families = []
    for root, wave, kind in zip(roots[chosen], waves, kinds, strict=True):
        key = wave, bool(root.imag > 0) and speed > 0
        counts[key] = counts.get(key, 0) + (kind is None)
        both = 0 < 2 * wave < blades and speed == 0  # at rest both directions are one
        families.append(kind or f"blade {(counts[key] + 1) // 2 if both else counts[key]}")
    return _Named(roots=roots[chosen], shapes=shapes[: 3 * blades + 2, chosen], waves=waves, families=families)


def _named_by_likeness(model: ReducedModel, speed: float) -> _Named:
    """Name the modes of an uneven blisk after those of the even one: one to one, alike in root and shape as a whole.

    Two roots differ by |s - t| / (|s| + |t|), two shapes by 1 minus their modal assurance at tips and disk centre.
    Of each conjugate pair the root is taken whose wave goes the way of the even one.
    """
    even = _named_by_waves(_even_model(_evened(model.machine), model.reduction), speed)
    roots, shapes = _roots(model, speed)
    upper = np.flatnonzero(roots.imag > 0)
    roots, shapes = roots[upper], shapes[: len(even.shapes), upper]
    one, other = (X / np.linalg.norm(X, axis=0) for X in (even.shapes, shapes))
    against = even.roots.imag < 0
    turned = np.where(against[:, None], roots.conj(), roots)
    apart = np.abs(turned - even.roots[:, None]) / (np.abs(roots) + np.abs(even.roots[:, None]))
    alike = np.where(against[:, None], np.abs(one.conj().T @ other.conj()), np.abs(one.conj().T @ other)) ** 2
    rows, columns = linear_sum_assignment(APART * apart + 1 - alike)
    return _Named(
        roots=turned[rows, columns],
        shapes=shapes[:, columns],
        waves=[even.waves[row] for row in rows],
        families=[even.families[row] for row in rows],
    )


def _evened(machine: Machine) -> Machine:
    return replace(machine, blades=replace(machine.blades, mistuning=None), faults=())


@lru_cache(maxsize=2)
def _even_model(machine: Machine, reduction: Reduction) -> ReducedModel:
    return reduce(machine, reduction)


def _roots(model: ReducedModel, speed: float) -> tuple[ComplexArray, ComplexArray]:
    """Return the roots of M s^2 + C s + K and their shapes (blisk DoFs, roots), which are 0 where a blade is lost."""
    system, own = model.at_speed(max(speed, REST)), model.own_dofs
    part = np.ix_(own, own)
    with one_blas_thread():
        roots, vectors = eig(*linearised(model.blisk.M[part], system.C[part], system.K[part]))
    shapes = np.zeros((len(model.blisk.M), roots.size), dtype=np.complex128)
    shapes[own] = vectors[: own.size]
    return roots, shapes


def _one_of_each_pair(roots: ComplexArray, shapes: ComplexArray, blades: int) -> tuple[list[int], list[int]]:
    """Return the numbers of the roots that have a wave of n >= 0, and each n.

    Of two conjugate roots one has n and the other -n. Where n and -n are the same wave, the root of positive frequency
    is taken.
    """
    tips = shapes[: 3 * blades].reshape(blades, 3, -1)
    power = np.sum(np.abs(np.fft.ifft(tips, axis=0)) ** 2, axis=1)  # row n: coefficient of e^(-i n phi_k)
    number = np.argmax(power, axis=0)
    signed = np.where(2 * number > blades, number - blades, number)
    alone = (signed == 0) | (2 * signed == blades)
    taken = np.flatnonzero(np.where(alone, roots.imag > 0, signed > 0))
    return taken.tolist(), signed[taken].tolist()


def _seen_from_the_shaft(
    model: ReducedModel, roots: ComplexArray, shapes: ComplexArray, kinds: list[str | None]
) -> ComplexArray:
    """Return the roots (modes,) with the conjugate one where a motion on the support goes against the rotation.

    Two blades do not show the direction of a wave, so disk centre and tilt do: for a root of positive frequency
    |x + i y| > |x - i y| is a motion with the rotation.
    """
    x, y, _, tilt_x, tilt_y, _ = model.blisk.centre @ shapes
    radius = model.machine.tip_radius_m
    ways = [np.hypot(np.abs(x + i * y), radius * np.abs(tilt_x + i * tilt_y)) for i in (1j, -1j)]
    sideways = np.array([kind in ("lateral", "tilt") for kind in kinds])
    return np.where(sideways & (ways[0] < ways[1]), roots.conj(), roots)


def _support_kinds(model: ReducedModel, shapes: ComplexArray) -> list[str | None]:
    """Return for each shape the spring of the support that has LEAST_SHARE of its elastic energy, or None."""
    total = np.einsum("im,ij,jm->m", shapes.conj(), model.stiffness(0.0), shapes).real
    each = model.springs[:, None] * np.abs(model.blisk.centre @ shapes) ** 2
    shares: dict[str, FloatArray] = {}
    for name, energy in zip(SUPPORTS, each, strict=True):
        shares[name] = shares.get(name, np.zeros_like(total)) + energy / total
    names = list(shares)
    table = np.array(list(shares.values()))
    largest = np.argmax(table, axis=0)
    return [names[row] if table[row, mode] >= LEAST_SHARE else None for mode, row in enumerate(largest)]


def lateral_springs(model: ReducedModel) -> tuple[float, ...]:
    """Return the lateral stiffness of the disk support along X and along Y, N/m; one value where they are equal."""
    k, uneven = float(model.springs[0]), model.machine.disk_support.lateral_stiffness_anisotropy
    return (k * (1 + uneven), k * (1 - uneven)) if uneven else (k,)


def critical_speeds_rpm(model: ReducedModel) -> tuple[float, ...]:
    """Return the critical speeds in rev/min of the `lateral_springs`: undamped, without contact or laws of the support.

    With even springs it is `ReducedModel.critical_speed_rpm`. Uneven springs k_m + k_a along X and k_m - k_a along Y
    join the forward whirl, which stands still in the turning frame, and the backward one, which turns there with -2
    Omega. With x of O_d in q_0, and x + i y of O_d in q_2 e^(-2 i theta), free whirl is

        (K_0 + Omega^2 A) q_0 + k_a T_x^T (T_x + i T_y) q_2 = 0
        2 (K_0 + Omega^2 (A - 4 M - 4 i G)) q_2 + k_a (T_x - i T_y)^T T_x q_0 = 0

    K_0 is the stiffness at rest with the springs k_m, A that of the speed. The motion is along X where both parts of
    O_d have one sign, else along Y. Of several speeds the one is taken whose mode has most motion of O_d. Whirls of
    other orders, which unequal blades add, are left out.
    """
    uneven = model.machine.disk_support.lateral_stiffness_anisotropy
    if not uneven:
        return (float(model.critical_speed_rpm),)
    blisk, size, x = model.blisk, len(model.blisk.M), 3 * model.machine.blades.count
    rest, k_a = model.stiffness(0.0), uneven * float(model.springs[0])
    stiffness = block_diag(rest, 2 * rest).astype(np.complex128)
    for row, factor in ((size + x, 1.0), (size + x + 1, 1j)):
        stiffness[x, row] += factor * k_a
        stiffness[row, x] += np.conj(factor) * k_a
    with one_blas_thread():
        inverse_squares, shapes = eigh(-block_diag(blisk.A, 2 * (blisk.A - 4 * blisk.M - 4j * blisk.G)), stiffness)
    forward, backward = shapes[x], shapes[size + x] + 1j * shapes[size + x + 1]
    along_x = (backward * forward.conj()).real > 0
    found = [np.argmax(np.where((inverse_squares > 0) & way, np.abs(forward), 0.0)) for way in (along_x, ~along_x)]
    return tuple(rev_per_min(float(1 / np.sqrt(inverse_squares[each]))) for each in found)


def synchronous_speeds(model: ReducedModel, stiffness: FloatArray) -> FloatArray:
    """Compute the speeds (stiffnesses, any) in rev/min at which forward whirl of the inertial frame meets 1X.

    Each row belongs to one value of `stiffness` (one or more,), the lateral stiffness of the disk support in N/m. It is
    ascending and filled up with NaN. At these speeds the undamped stiffness of the turning frame
    (`ReducedModel.stiffness`) is singular. Only speeds whose mode has one nodal diameter are returned, because an
    unbalance excites no other mode. Uneven springs count with their mean, and laws of the support are left out.
    """
    blades, rows = model.machine.blades.count, []
    for each in stiffness:
        springs = np.concatenate([[each, each], model.springs[2:]])
        with one_blas_thread():
            inverse_squares, shapes = eigh(-model.blisk.A, replace(model, springs=springs).stiffness(0.0))
        tips = shapes[: 3 * blades].reshape(blades, 3, -1)
        waves = np.argmax(np.sum(np.abs(np.fft.rfft(tips, axis=0)) ** 2, axis=1), axis=0)
        met = (inverse_squares > 0) & (waves == 1)
        rows.append(np.sort(rev_per_min(1.0) / np.sqrt(inverse_squares[met])))
    table = np.full((len(rows), max(map(len, rows))), np.nan)
    for row, values in zip(table, rows, strict=True):
        row[: len(values)] = values
    return table


def casing_diameters(model: ReducedModel) -> list[int]:
    """Return the number of waves around the casing of each of its modes: the order with the largest motion.

    Radial and circumferential motion count. A ring that turns as a whole on its springs has 0 waves.
    """
    shapes = model.casing.modes_xy
    angle = 2 * np.pi * np.arange(len(shapes)) / len(shapes)
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    parts = np.stack([cos * shapes[:, 0] + sin * shapes[:, 1], cos * shapes[:, 1] - sin * shapes[:, 0]])
    power = np.abs(np.fft.rfft(parts, axis=1)) ** 2
    power[:, 0] /= 2  # a wave has its other half at the negative order
    waves: list[int] = np.argmax(power.sum(axis=0), axis=0).tolist()
    return waves
