"""Keep the replay track: the whole motion, frame by frame, over the few turns about the hardest touch."""

from collections import deque
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.observers.observer import Observer
from rubgen.solver.response import Track
from rubgen.solver.scheme.turn_kernels import IMPULSE
from rubgen.solver.speed.driver import SpeedDriver
from rubgen.solver.speed.turn import Turn, TurnFrames

TRACK_TURNS = 8


class TrackKeeper(Observer):
    """Keeps the frames of the eight turns around the hardest touch, the touch with the largest impulse.

    Turns of the record before `first_turn` are left out. Without a touch the first eight turns are kept. The memory of
    the frames does not grow with the number of turns. At a changing speed the tips' growth is kept for every turn.
    """

    def __init__(self, driver: SpeedDriver, record: int, first_turn: int) -> None:
        self.driver, self.record, self.first_turn = driver, record, first_turn
        self.kept, self.hardest = list[TurnFrames](), -1.0
        self.growth: list[FloatArray] = []
        self.frames: deque[TurnFrames] = deque(maxlen=TRACK_TURNS)
        self.touches: deque[float] = deque(maxlen=TRACK_TURNS)

    def turn(self, turn: Turn) -> None:
        """Add the frames of a turn."""
        if turn.number >= 0 and not (self.growth and self.driver.rotation.is_steady):
            self.growth.append(turn.tip_growth)
        if turn.number >= self.first_turn:
            self.frames.append(turn.frames)
            self.touches.append(max(float(touches[:, IMPULSE].max(initial=0.0)) for touches in turn.touches))
            if len(self.frames) == TRACK_TURNS:
                touches = list(self.touches)
                first = TRACK_TURNS // 2 if self.kept else 0  # the first window answers for its first half too
                self._keep_where_harder(max(touches[first : TRACK_TURNS // 2 + 1]))
        if turn.number == self.record - 1:
            # The last window answers for its second half, a record that is shorter than a window for all.
            touches = list(self.touches)
            self._keep_where_harder(max(touches[TRACK_TURNS // 2 :] or touches, default=-1.0))

    def _keep_where_harder(self, touch: float) -> None:
        if touch > self.hardest:
            self.hardest, self.kept = touch, list(self.frames)

    def result(self) -> dict[str, Any]:
        """Return the field `track`; None where no turn was recorded."""
        if not self.kept:
            return {"track": None}
        blocks, system = self.driver.stepper.blocks, self.driver.stepper.system
        q = np.array([blocks.to_q(z) for frames in self.kept for z in frames.z]).reshape(-1, len(system.M))
        track = Track(
            step=np.concatenate([frames.step for frames in self.kept]),
            q=q,
            tip_growth=np.array(self.growth),
            casing_modes=system.casing_modes,
        )
        return {"track": track}
