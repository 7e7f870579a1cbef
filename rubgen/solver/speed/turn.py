"""The result of one turn."""

from dataclasses import dataclass
from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.solver.scheme.turn_kernels import TurnResult


class TurnFrames(NamedTuple):
    """About 32 moments of a turn."""

    step: IntArray
    """Their steps (frames,), counted from the first of the record."""
    z: FloatArray
    """The motion there in blocks (frames, any)."""


@dataclass(frozen=True, kw_only=True)
class Turn:
    """The outputs of one turn. Arrays of `result` are overwritten by the next turn."""

    number: int
    """Its number in the record; negative in the settling."""
    code: int
    """A code of `state_kernels`."""
    step: int
    """The step of the turn where it ended."""
    first_step: int
    """Number of its first step, counted from the first of the record."""
    end_step: int
    """Number of the first step of the next turn."""
    recording: bool
    """Whether taps, orbit and arrivals were made."""
    result: TurnResult
    touches: list[FloatArray]
    """Touches that ended, each (any, 8) with the columns of `turn_kernels`."""
    arrivals: FloatArray
    """Passages under timing probes (any, 4)."""
    opening: FloatArray
    """Opening of the surface at steps -1, 0, ..., steps of the turn, or of its last part (steps + 2,), m."""
    frames: TurnFrames
    tip_growth: FloatArray
    """Steady displacement of the tips in the turn, or in its first part (n_blades, 3), m."""
