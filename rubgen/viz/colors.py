"""Colours that people with colour-blindness tell apart (Okabe, Ito 2008), the same in every picture."""

from __future__ import annotations

from rubgen.labels.labels import Motion

BLUE, GREEN, ORANGE, VERMILION, GREY = "#0072b2", "#009e73", "#e69f00", "#d55e00", "#8c8c8c"
MOTION_COLORS = {
    Motion.STATIC: GREY,
    Motion.PERIOD_1: BLUE,
    Motion.PERIOD_K: GREEN,
    Motion.QUASI_PERIODIC: ORANGE,
    Motion.CHAOTIC: VERMILION,
}


def rgba(color: str) -> int:
    """An opaque colour `#rrggbb` as the number 0xrrggbbff that Rerun takes."""
    return int(f"{color.lstrip('#')}ff", 16)
