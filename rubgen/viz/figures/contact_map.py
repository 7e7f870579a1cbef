"""Where contact loads the casing, as a ring of bars."""

import numpy as np
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from rubgen.arrays import FloatArray
from rubgen.viz.colors import BLUE, GREY, PAPER_GREY
from rubgen.viz.figures.style import INK, note
from rubgen.viz.sectors import sector_of

SECTORS = 90


def contact_map(axes: PolarAxes, angle: FloatArray, impulse: FloatArray, turns: float) -> None:
    """Draw the normal impulse a turn, in mN s, of touches at polar angles of the casing, in sectors of 4 degrees.

    `angle` (touches,) is in rad, `impulse` (touches,) in N s over all `turns`. A sector lies about 0.
    """
    width = 2 * np.pi / SECTORS
    per_turn = 1e3 * np.bincount(sector_of(angle, SECTORS), weights=impulse, minlength=SECTORS) / turns
    axes.bar(width * np.arange(SECTORS), per_turn, width=width, color=BLUE, linewidth=0, zorder=3)
    axes.set_xticks(np.radians(np.arange(0, 360, 45)))
    axes.tick_params(labelsize=9, colors=INK)
    axes.grid(color=PAPER_GREY, linewidth=0.7)
    axes.spines[["polar", "inner"]].set_color(GREY)
    axes.set_rlabel_position(112.5)
    axes.yaxis.set_major_locator(MaxNLocator(3))
    axes.set_xlabel(
        "Contact impulse in a turn and 4°, mN s, over the casing's angle", fontsize=10, color=INK, labelpad=8
    )
    if per_turn.any():
        axes.set_rorigin(-0.6 * per_turn.max())  # a ring: near a point no sector could be told from its neighbour
    else:
        axes.set_yticks([])
        note(axes, "no contact")
