"""Say how fast a diverging run has grown, and what to change."""

import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.scheme.stepper import Stepper

GROWTH_TURNS = 10
"""Rates of growth are means over this many last turns."""
STEADY_GROWTH = math.log(2)
"""A motion that has less than doubled over these turns has not grown: it is irregular, and only left its range for a
moment."""

ADVICE = {
    "blade": (
        "of 24 such runs of the preset 21 stayed in range with friction 0.02, 12 with a quarter of the casing's "
        "support stiffness, 10 with four times the damping of the blades (docs/status.md)"
    ),
    "casing": (
        "of 24 such runs of the preset 21 stayed in range with four times the casing's support stiffness, 11 with half "
        "the unbalance, 10 with four times the damping of the casing (docs/status.md)"
    ),
}
"""What to change, by the branch that left its range. The numbers were counted, see docs/status.md."""


class Growth:
    """Keeps the amplitudes of casing and blade tips over the last turns of a stepper, for the reason of a divergence.

    The casing's amplitude is the largest bound of its displacement within the turn. The blades' amplitude is the
    largest tip coordinate in the frames of the turn. It is evaluated only in `sentence`.
    """

    def __init__(self, stepper: Stepper) -> None:
        self.stepper = stepper
        self.turns: deque[tuple[float, FloatArray]] = deque(maxlen=GROWTH_TURNS + 1)

    def add(self, steps: int) -> None:
        """Add the turn that was just run. `steps` is the number of steps that it made."""
        result = self.stepper.result
        count = math.ceil(steps * len(result.frames) / self.stepper.steps)
        self.turns.append((float(result.summary[2]), result.frames[:count]))

    def sentence(self) -> str:
        """Return a clause on how blades and casing have grown over the last turns, with rates per turn and second."""
        amplitudes = {"blades": self._blades(), "casing": [casing for casing, _ in self.turns]}
        trends = {name: found for name, sizes in amplitudes.items() if (found := trend(np.array(sizes)))}
        if not trends:
            return "too soon to tell a rate of growth"
        rates = ", ".join(f"{name} {found.text(self._turn_seconds)}" for name, found in trends.items())
        grows = any(found.rate * found.turns > STEADY_GROWTH for found in trends.values())
        kind = "growing" if grows else "no steady growth, an excursion of an irregular motion"
        return f"{kind}: rate over the last {len(self.turns) - 1} turns {rates}"

    @property
    def _turn_seconds(self) -> float:
        return float(self.stepper.dt * self.stepper.turn_steps)

    def _blades(self) -> list[float]:
        """Return the largest tip coordinate of each turn, m; 0 where a turn has no frame."""
        tips = 3 * self.stepper.system.n_blades
        return [
            max((float(np.abs(self.stepper.blocks.to_q(z)[:tips]).max()) for z in frames), default=0.0)
            for _, frames in self.turns
        ]


def what_diverged(stepper: Stepper) -> tuple[str, str]:
    """Return what has left the valid range, "blade" or "casing", and a clause with its limit.

    The last turn of `stepper` must have failed with the code DIVERGED.
    """
    system, laws = stepper.system, stepper.model.laws
    tips = np.abs(stepper.coordinates.after[: 3 * system.n_blades])
    if not np.all(tips <= laws.tip_limit):
        blade = int(np.argmax(~(tips <= laws.tip_limit))) // 3
        return "blade", f"blade {blade} bent beyond {1e3 * laws.tip_limit:.3g} mm"
    return "casing", f"the casing left {1e3 * laws.casing_limit:.3g} mm"


@dataclass(frozen=True, kw_only=True)
class Trend:
    """Growth exp(rate k) of an amplitude over turns k, and its geometric mean `size` in m.

    `turns` is the number of turns from the first amplitude to the last.
    """

    rate: float
    size: float
    turns: int

    def text(self, turn_seconds: float) -> str:
        """Write the rates per turn and per second, and the size."""
        return f"{self.rate:+.3g} a turn ({self.rate / turn_seconds:+.3g} 1/s) about {1e3 * self.size:.3g} mm"


def trend(amplitudes: FloatArray) -> Trend | None:
    """Fit the growth of amplitudes (turns,), m, by least squares on their logarithms.

    Amplitudes that are zero, NaN or infinite are left out. None where fewer than two are left.
    """
    known = np.isfinite(amplitudes) & (amplitudes > 0)
    if known.sum() < 2:
        return None
    turns, logarithms = np.flatnonzero(known), np.log(amplitudes[known])
    rate = float(np.polyfit(turns, logarithms, 1)[0])
    return Trend(rate=rate, size=float(np.exp(logarithms.mean())), turns=int(turns[-1] - turns[0]))
