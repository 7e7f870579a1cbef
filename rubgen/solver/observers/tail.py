"""Keep the taps (true signals) and the passages under timing probes of the last turns, the tail of a run."""

from collections import deque
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.observers.observer import Observer
from rubgen.solver.response import TipArrivals
from rubgen.solver.scheme.taps import sampled_taps, timing_taps
from rubgen.solver.speed.turn import Turn
from rubgen.taps import Tap


class Tail(Observer):
    """Keeps all taps, and all passages under timing probes, of the last `turns` turns."""

    def __init__(self, taps: tuple[Tap, ...], turns: int) -> None:
        self.wanted = taps
        self.taps: deque[FloatArray] = deque(maxlen=turns)
        self.arrivals: deque[FloatArray] = deque(maxlen=turns)

    def turn(self, turn: Turn) -> None:
        """Add the taps and passages of a turn. A turn without recording is left out."""
        if turn.recording:
            self.taps.append(turn.result.taps.copy())
            self.arrivals.append(turn.arrivals)

    def result(self) -> dict[str, Any]:
        """Return the fields `taps` and `arrivals`."""
        sampled = sampled_taps(self.wanted)
        tail = np.concatenate([np.zeros((len(sampled), 0)), *self.taps], axis=1)
        return {
            "taps": {tap.name: np.ascontiguousarray(tail[i]) for i, tap in enumerate(sampled)},
            "arrivals": tip_arrivals(list(self.arrivals), [probe.name for probe in timing_taps(self.wanted)]),
        }


def tip_arrivals(arrivals: list[FloatArray], names: list[str]) -> dict[str, TipArrivals]:
    """Sort arrivals by probe and then by time. Return the arrivals of each probe by the probe's name.

    Each array of `arrivals` is (any, 4): number of the probe, blade, time in steps, displacement in m. `names` are the
    names of the probes, in the order of their numbers. A probe without arrivals has empty arrays.
    """
    rows = np.concatenate([np.zeros((0, 4)), *arrivals])
    seen = {}
    for number, name in enumerate(names):
        own = rows[rows[:, 0] == number]
        own = own[np.argsort(own[:, 2], kind="stable")]
        seen[name] = TipArrivals(blade=own[:, 1].astype(np.int64), step=own[:, 2].copy(), displacement=own[:, 3].copy())
    return seen
