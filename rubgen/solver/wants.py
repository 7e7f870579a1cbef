"""What `integrate` integrates, and what its response records."""

from dataclasses import dataclass
from typing import Protocol

from rubgen.reduction.model import SpinningSystem
from rubgen.taps import DEFAULT_TAPS, Tap


class SpeedModel(Protocol):
    """The interface of a model that makes the spinning system at any speed, such as `reduction.ReducedModel`."""

    def at_speed(self, speed: float, acceleration: float = 0.0) -> SpinningSystem:
        """Return the system at a speed in rad/s and an acceleration in rad/s2."""
        ...


@dataclass(frozen=True, kw_only=True)
class Wants:
    """What a response records, and for how long. No field changes the motion."""

    tail_seconds: float = 0.0
    """Seconds that the taps cover, 100 turns at least; they may reach back before the record, not before the start."""
    sample_rate_hz: float = 0.0
    """The sensors' rate, which the steps must feed 2.56 times."""
    companion: bool = False
    """Whether a companion trajectory runs beside the record, for the Lyapunov exponent; at a steady speed only."""
    companion_stops: bool = True
    """Whether it stops once it has settled the exponent."""
    repeats_free_turn: bool = False
    """Whether a run that never touches may be made from one turn of its rub-free motion: equal but for rounding."""
    taps: tuple[Tap, ...] = DEFAULT_TAPS
    """The taps (`rubgen.taps`); the response holds each by its name."""
