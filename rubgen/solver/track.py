"""The replay track: the whole motion, frame by frame, over the few turns about the hardest touch."""

from __future__ import annotations

from collections import deque

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.response import Track
from rubgen.solver.stepper import Stepper
from rubgen.solver.turn_kernels import IMPULSE

TRACK_TURNS = 8


class TrackKeeper:
    """Keeps the frames of the eight turns whose middle saw the hardest touch; memory does not grow with turns.

    Turns before `first_turn` are passed over. Without any touch the first eight turns are kept.
    """

    def __init__(self, first_turn: int) -> None:
        self.first_turn = first_turn
        self.kept_from, self.kept, self.hardest = first_turn, list[FloatArray](), -1.0
        self.frames: deque[FloatArray] = deque(maxlen=TRACK_TURNS)
        self.touches: deque[float] = deque(maxlen=TRACK_TURNS)

    def add(self, turn: int, stepper: Stepper, ended: int) -> None:
        """Take the frames of a turn that was just run, with its `ended` touches."""
        if turn < self.first_turn:
            return
        impulses = stepper.touches.ended[:ended, IMPULSE]
        self.frames.append(stepper.result.frames.copy())
        self.touches.append(float(impulses.max(initial=0.0)))
        if len(self.frames) == TRACK_TURNS:
            touches = list(self.touches)
            first = TRACK_TURNS // 2 if self.kept else 0  # the first window answers for its first half too
            self._keep_where_harder(turn, max(touches[first : TRACK_TURNS // 2 + 1]))

    def finish(self, last_turn: int) -> None:
        """The last window answers for its second half, a record that is shorter than a window for all."""
        touches = list(self.touches)
        self._keep_where_harder(last_turn, max(touches[TRACK_TURNS // 2 :] or touches, default=-1.0))

    def _keep_where_harder(self, turn: int, touch: float) -> None:
        if touch > self.hardest:
            self.hardest, self.kept, self.kept_from = touch, list(self.frames), turn + 1 - len(self.frames)

    def track(self, stepper: Stepper, settle: int) -> Track:
        """What was kept, its steps counted from the record's first, which follows `settle` turns."""
        system, steps = stepper.system, stepper.steps
        count = stepper.result.frames.shape[0]
        in_turn = -(-np.arange(count) * steps // count)
        turns = self.kept_from - settle + np.arange(len(self.kept))
        q = np.array([stepper.blocks.to_q(z) for turn in self.kept for z in turn]).reshape(-1, len(system.M))
        return Track(
            step=(turns[:, None] * steps + in_turn).ravel(),
            q=q,
            tip_growth=system.tip_static,
            casing_modes=system.casing_modes,
        )
