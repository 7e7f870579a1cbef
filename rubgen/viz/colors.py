"""Colours that colour-blind people can distinguish (Okabe, Ito 2008), the same in every picture."""

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.labels.labels import Motion

UInt32Array = npt.NDArray[np.uint32]
BLUE, GREEN, ORANGE, VERMILION, GREY = "#0072b2", "#009e73", "#e69f00", "#d55e00", "#8c8c8c"
SKY = "#56b4e9"
PAPER_GREY = "#dddddd"
PURPLE = "#cc79a7"
UNBALANCE = PURPLE
LINES = (BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILION)
"""Channels of one quantity, in their order."""
MOTION_COLORS = {
    Motion.STATIC: GREY,
    Motion.PERIOD_1: BLUE,
    Motion.PERIOD_K: GREEN,
    Motion.QUASI_PERIODIC: ORANGE,
    Motion.UNDECIDED: SKY,
    Motion.CHAOTIC: VERMILION,
}

IMPULSE_COLORS = np.array([0xFFE8A0FF, 0xFFD166FF, 0xF4A340FF, 0xE6752BFF, 0xD55E00FF, 0xA63A00FF], dtype=np.uint32)
"""From a light touch to a hard one: lightness falls evenly, so that it is readable in grey."""


def impulse_color(share: FloatArray) -> UInt32Array:
    """Return colours (any,) of touches as numbers 0xrrggbbff, from light to hard.

    `share` (any,) is the square root of a touch's impulse over the largest impulse, in [0, 1].
    """
    place = np.minimum((share * len(IMPULSE_COLORS)).astype(int), len(IMPULSE_COLORS) - 1)
    return np.asarray(IMPULSE_COLORS[place])


def rgba(color: str) -> int:
    """Convert a colour `#rrggbb` to the opaque number 0xrrggbbff for Rerun."""
    return int(f"{color.lstrip('#')}ff", 16)
