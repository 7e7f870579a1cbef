"""The replay track: the whole motion, frame by frame, over the few turns about the hardest touch."""

from __future__ import annotations

from collections import deque

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.response import Track
from rubgen.solver.scheme.turn_kernels import IMPULSE
from rubgen.solver.speed.driver import Spin, TurnFrames

TRACK_TURNS = 8


class TrackKeeper:
    """Keeps the frames of the eight turns whose middle saw the hardest touch; memory does not grow with turns.

    Turns before `first_turn` are passed over. Without any touch the first eight turns are kept.
    """

    def __init__(self, first_turn: int) -> None:
        self.first_turn = first_turn
        self.kept, self.hardest = list[TurnFrames](), -1.0
        self.growth: list[FloatArray] = []
        self.frames: deque[TurnFrames] = deque(maxlen=TRACK_TURNS)
        self.touches: deque[float] = deque(maxlen=TRACK_TURNS)

    def add(self, turn: int, spin: Spin) -> None:
        """Take the frames of a turn that was just run."""
        if turn >= spin.settle and not (self.growth and spin.rotation.is_steady):
            self.growth.append(spin.tip_growth)
        if turn < self.first_turn:
            return
        self.frames.append(spin.frames)
        self.touches.append(max(float(touches[:, IMPULSE].max(initial=0.0)) for touches in spin.touches))
        if len(self.frames) == TRACK_TURNS:
            touches = list(self.touches)
            first = TRACK_TURNS // 2 if self.kept else 0  # the first window answers for its first half too
            self._keep_where_harder(max(touches[first : TRACK_TURNS // 2 + 1]))

    def finish(self) -> None:
        """The last window answers for its second half, a record that is shorter than a window for all."""
        touches = list(self.touches)
        self._keep_where_harder(max(touches[TRACK_TURNS // 2 :] or touches, default=-1.0))

    def _keep_where_harder(self, touch: float) -> None:
        if touch > self.hardest:
            self.hardest, self.kept = touch, list(self.frames)

    def track(self, spin: Spin) -> Track:
        """What was kept."""
        blocks, system = spin.stepper.blocks, spin.stepper.system
        q = np.array([blocks.to_q(z) for frames in self.kept for z in frames.z]).reshape(-1, len(system.M))
        return Track(
            step=np.concatenate([frames.step for frames in self.kept]),
            q=q,
            tip_growth=np.array(self.growth),
            casing_modes=system.casing_modes,
        )
