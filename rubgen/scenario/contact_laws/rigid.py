"""The law of rigid contact."""

from dataclasses import dataclass

from rubgen.arrays import FloatArray
from rubgen.scenario.contact_laws.law import NormalLaw


@dataclass(frozen=True)
class Rigid(NormalLaw):
    """No tip enters the casing: force and gap are at least 0, and one of the two is 0 (Signorini)."""

    def numbers(self, _dt: float) -> tuple[float, ...]:
        """Return no constants: the law has none."""
        return ()

    @staticmethod
    def respond(_numbers: FloatArray, force: float, gap: float, compliance: float, _before: float) -> float:
        """Return the force that closes the gap, in N; 0 where the gap is open without a force."""
        return max(0.0, force - gap / compliance)
