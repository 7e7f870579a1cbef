"""Colours that people with colour-blindness tell apart (Okabe, Ito 2008), the same in every picture."""

from __future__ import annotations

from rubgen.labels.labels import Motion

BLUE, SKY, GREEN, YELLOW = "#0072b2", "#56b4e9", "#009e73", "#f0e442"
ORANGE, VERMILION, PURPLE, GREY = "#e69f00", "#d55e00", "#cc79a7", "#8c8c8c"
MOTION_COLORS = {
    Motion.STATIC: GREY,
    Motion.PERIOD_1: BLUE,
    Motion.PERIOD_K: GREEN,
    Motion.QUASI_PERIODIC: ORANGE,
    Motion.CHAOTIC: VERMILION,
}
