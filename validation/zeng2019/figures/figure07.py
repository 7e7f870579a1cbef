"""Figure 7: frequencies of one blade, of the disk and of the blisk by nodal diameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rubgen.machine.published import BLISK_HZ
from rubgen.viz.colors import BLUE, GREY, ORANGE, VERMILION
from validation.piece import Found, Piece
from validation.zeng2019.drawing.style import new_figure, style
from validation.zeng2019.models.mode_shapes import coupled_modes
from validation.zeng2019.section import Section
from validation.zeng2019.size import Size
from validation.zeng2019.statement import UNKNOWABLE, Statement, by_deviation, yes_or_no

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BAND_HZ = (BLISK_HZ[5], BLISK_HZ[39])
FIRST_IN_BAND, LAST_IN_BAND = 5, 40
MODES = 100
COUPLED = 0.01
"""A blade family is coupled with the disk where the disk moves one of its frequencies by more than 1 %."""
COUPLED_MODES = Piece(coupled_modes, (MODES,))


def pieces(_size: Size) -> Sequence[Piece]:
    """One: modes of the parts and of the whole."""
    return [COUPLED_MODES]


def statements(_size: Size, found: Found) -> Sequence[Statement]:
    """What is disk, what is blade, and where the two meet."""
    modes = found(COUPLED_MODES)
    hz, nd, share = modes["blisk_hz"], modes["blisk_nd"], modes["blade_share"]
    band = slice(FIRST_IN_BAND - 1, LAST_IN_BAND)
    led = int(np.sum(share[:42] > 0.5))
    inside, outside = hz[band], np.delete(hz[:42], np.arange(FIRST_IN_BAND - 1, LAST_IN_BAND))
    low, high = BAND_HZ
    apart = np.abs(hz[band] / modes["blade_hz"][0] - 1)
    stirred = sorted(set(nd[band][apart > COUPLED].tolist()))
    return [
        Statement(
            statement="The modes fall into two kinds, led by the disk and led by the blades.",
            verdict=yes_or_no(bool((share[band] > 0.5).all()) and led == LAST_IN_BAND - FIRST_IN_BAND + 1),
            found=f"{led} of the first 42 have more than half their kinetic energy in the blades: modes "
            f"{FIRST_IN_BAND} to {LAST_IN_BAND}",
        ),
        Statement(
            statement=f"The modes led by the blades lie between {low} and {high} Hz.",
            verdict=by_deviation(max(abs(inside[0] / low - 1), abs(inside[-1] / high - 1)), 0.02),
            found=f"{inside[0]:.2f} to {inside[-1]:.2f} Hz in the full model (nearest outside: "
            f"{outside[outside < inside[0]].max():.2f} and {outside[outside > inside[-1]].min():.2f} Hz)",
            why="The two ends were fitted, in the reduced model; the full one lies below it.",
            used_for_fitting=True,
        ),
        Statement(
            statement="In that band only the disk's low nodal diameters are coupled with the blades.",
            verdict=yes_or_no(stirred in ([0, 1], [1])),
            found=f"moved by more than {100 * COUPLED:.0f} % from one clamped blade's frequency: nodal diameters "
            f"{', '.join(map(str, stirred)) or 'none'}",
            why="Only these move the hub against its springs. For higher ones the thick disk is at rest.",
        ),
        _families(modes["blade_hz"]),
    ]


def _families(blade_hz: np.ndarray) -> Statement:
    first = ", ".join(f"{value:.0f}" for value in blade_hz[:4])
    return Statement(
        statement="Only the first two bending modes of a blade are coupled with the disk.",
        verdict=UNKNOWABLE,
        found=f"one clamped blade: {first}, ... Hz",
        why="The range of frequencies is lost with the figure: coupling of further families cannot be compared.",
    )


def figures(_size: Size, found: Found) -> dict[str, Figure]:
    """Frequencies over the nodal diameter, and the band of the first blade family enlarged."""
    modes = found(COUPLED_MODES)
    figure = new_figure(9.5, 3.6)
    for axes, (low, high) in zip(figure.subplots(1, 2), ((0, 1200), (150, 170)), strict=True):
        for hz in modes["blade_hz"]:
            axes.axhline(hz, color=ORANGE, linewidth=0.8)
        axes.plot(modes["disk_nd"], modes["disk_hz"], "s", color=GREY, markersize=5, markerfacecolor="none")
        led = modes["blade_share"] > 0.5
        for chosen, color in ((led, BLUE), (~led, VERMILION)):
            axes.plot(modes["blisk_nd"][chosen], modes["blisk_hz"][chosen], ".", color=color, markersize=5)
        axes.set(ylim=(low, high), xlim=(-0.5, 18.5))
        style(axes, "Nodal diameter", "Frequency, Hz")
    caption = "Frequencies by nodal diameter: blade (lines), disk (squares), blisk led by blades (blue) or disk (red)"
    return {caption: figure}


SECTION = Section(
    name="7",
    title="Figure 7: frequencies by nodal diameter",
    text="All values are from the full model at rest. The nodal diameter is the leading wave number of the tips; for "
    "the disk alone it is the leading wave number of the rim. The share of the blades is their share of the "
    "kinetic energy.",
    pieces=pieces,
    statements=statements,
    figures=figures,
)
