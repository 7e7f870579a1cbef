"""Draw the response of a machine to its unbalance without rub, and its critical speeds over the support's stiffness."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.reduction import ReducedModel
from rubgen.reduction.modes import critical_speeds_rpm, lateral_springs, synchronous_speeds
from rubgen.units import rad_per_s
from rubgen.viz.colors import BLUE, GREY, ORANGE, VERMILION
from rubgen.viz.figures.style import head, label_axes, new_figure, speeds_in_words

SPEEDS, STIFFNESSES = 401, 121
TIMES_CRITICAL = 2.0
"""The response is drawn up to this many times the critical speed."""
DECADES = 2.0
"""The map reaches so many decades below and above the machine's own stiffness."""
HIGHEST_RPM = 60_000.0
LONG = 10.0
"""A logarithmic axis from this factor on has fewer numbers in a decade."""
SEEN = 1e-6
"""A backward whirl below this share of the largest forward one is not drawn: it is rounding."""


def unbalance_response(model: ReducedModel, speeds_rpm: tuple[float, float] | None = None) -> Figure:
    """Draw amplitude and phase of the disk centre's 1X whirl over the speed, each speed steady and without contact.

    The response is exact for the linear system: nothing is integrated in time. The phase is the angle of the forward
    whirl from blade 0 in the sense of rotation, in degrees: it falls where the whirl lags more. Uneven supports and
    laws of the support add a backward whirl. `speeds_rpm` is the range in rev/min; None is up to twice the critical
    speed.
    """
    criticals = critical_speeds_rpm(model)
    low, high = speeds_rpm or (0.0, TIMES_CRITICAL * model.critical_speed_rpm)
    speeds = np.linspace(max(low, high / SPEEDS), high, SPEEDS)
    forward, backward = whirl_of_unbalance(model, speeds).T
    figure = new_figure(9.0, 5.6)
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot(speeds, 1e6 * np.abs(forward), color=BLUE, linewidth=1.2, label="forward")
    lower.plot(speeds, np.degrees(np.unwrap(np.angle(forward))), color=BLUE, linewidth=1.2)
    if np.abs(backward).max() > SEEN * np.abs(forward).max():
        upper.plot(speeds, 1e6 * np.abs(backward), "--", color=ORANGE, linewidth=1.2, label="backward")
        upper.legend(frameon=False, fontsize=9)
    for axes in (upper, lower):
        for critical in criticals:
            if low < critical < high:
                axes.axvline(critical, color=VERMILION, linewidth=0.8, linestyle=":", zorder=1)
        axes.set_xlim(low, high)
    label_axes(upper, "", "Disk centre, 1X, µm")
    dotted = f"undamped critical speed{'s' * (len(criticals) > 1)}, {speeds_in_words(criticals)} rev/min"
    label_axes(lower, f"Speed, rev/min (dotted: {dotted})", "Phase, degrees")
    upper.set_ylim(bottom=0)
    unbalance = 1e3 * model.machine.unbalance_kg_m
    more = f" and {len(model.machine.unbalances)} more" if model.machine.unbalances else ""
    head(figure, f"{model.machine.name}: response to the unbalance of {unbalance:.3g} g m{more}, without contact")
    return figure


def whirl_of_unbalance(model: ReducedModel, speeds_rpm: FloatArray) -> ComplexArray:
    """Compute the complex amplitudes (speeds, 2) of the disk centre's forward and backward 1X whirl, m.

    x + i y = forward e^(i theta) + backward e^(-i theta) + other orders, in the inertial frame, at each steady speed of
    `speeds_rpm` (speeds,) in rev/min, without contact (`rub_free_motion`). In the turning frame the forward part is the
    mean of the motion and the backward part turns with -2 theta.
    """
    from rubgen.solver.linear.rub_free import rub_free_motion  # it imports kernels, which readers must not

    rows = []
    for speed in rad_per_s(1.0) * speeds_rpm:
        system = model.at_speed(float(speed))
        x, y = rub_free_motion(system).harmonics[:, system.centre : system.centre + 2].T
        backward = (np.conj(x[2]) + 1j * np.conj(y[2])) / 2 if len(x) > 2 else 0.0
        rows.append((x[0].real + 1j * y[0].real, backward))
    return np.array(rows, dtype=np.complex128)


def critical_map(model: ReducedModel, speeds_rpm: tuple[float, float] | None = None) -> Figure:
    """Draw the critical speeds over the lateral stiffness of the disk support, on logarithmic axes.

    A critical speed is a speed at which a forward whirl of the inertial frame meets 1X. Modes are undamped and without
    contact. The machine's own stiffness, or that of each of its uneven springs, is marked with its critical speeds.
    `speeds_rpm` is the drawn range of speeds in rev/min; None chooses it.
    """
    springs = lateral_springs(model)
    stiffness = float(model.springs[0]) * np.logspace(-DECADES, DECADES, STIFFNESSES)
    speeds = synchronous_speeds(model, stiffness)
    marked = (
        np.array(critical_speeds_rpm(model))[:, None]
        if len(springs) > 1
        else synchronous_speeds(model, np.array(springs))
    )
    low, high = speeds_rpm or (0.8 * float(np.nanmin(speeds)), HIGHEST_RPM)
    inside = np.where((speeds >= low) & (speeds <= high), speeds, np.nan)
    if speeds_rpm is None:
        high = min(HIGHEST_RPM, 1.25 * float(np.nanmax(inside)))
    figure = new_figure(8.0, 5.2)
    axes = figure.subplots()
    axes.loglog(stiffness, inside, color=BLUE, linewidth=1.3)
    for own, of_own in zip(springs, marked, strict=True):
        axes.axvline(own, color=GREY, linewidth=0.9, linestyle="--", zorder=1)
        left = own < max(springs)  # of two springs the softer one has its numbers on the left
        for speed in _apart(of_own[(of_own >= low) & (of_own <= high)]):
            axes.plot(own, speed, "o", color=VERMILION, markersize=5, zorder=5)
            axes.annotate(
                f"{speed:,.0f} rev/min", (own, speed), xytext=(-8, 5) if left else (8, -5), textcoords="offset points",
                fontsize=9, color=VERMILION, va="bottom" if left else "top", ha="right" if left else "left",
            )  # fmt: skip
    _plain_numbers(axes, low, high)
    axes.set(xlim=(stiffness[0], stiffness[-1]))
    dashed = " and ".join(f"{each:.3g}" for each in sorted(springs))
    label_axes(
        axes, f"Lateral stiffness of the disk support, N/m (dashed: this machine, {dashed})", "Critical speed, rev/min"
    )
    axes.grid(which="both", color=GREY, alpha=0.25, linewidth=0.5)
    head(figure, f"{model.machine.name}: critical speeds (forward whirl at 1X), undamped, without contact")
    return figure


def _apart(speeds: FloatArray) -> FloatArray:
    """Return the speeds without those within 0.1 % of a lower one: both directions of an even blisk are one."""
    ordered = np.sort(speeds)
    return ordered[np.append(True, np.diff(ordered) > 1e-3 * ordered[1:])] if ordered.size else ordered


def _plain_numbers(axes: Axes, low: float, high: float) -> None:
    """Write the speeds of a logarithmic axis as whole numbers, several in each decade."""
    axes.set_ylim(low, high)
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0, 7.0) if high < LONG * low else (1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
