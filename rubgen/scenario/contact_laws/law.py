"""The base class of a law of the normal contact force."""

from abc import ABC, abstractmethod
from typing import ClassVar

from rubgen.arrays import FloatArray


class NormalLaw(ABC):
    """How the normal force of a contact follows from its gap.

    The fields of a law are its keys in the table `[contact]` of a recipe. All energy terms follow from the force.
    """

    REGARDS_RATE: ClassVar[bool] = False
    """Whether `respond` uses the gap two steps earlier, as a law that damps does."""

    @abstractmethod
    def numbers(self, dt: float) -> tuple[float, ...]:
        """Return the constants of the law that `respond` takes, for time steps of `dt` (s)."""

    @staticmethod
    @abstractmethod
    def respond(numbers: FloatArray, force: float, gap: float, compliance: float, before: float) -> float:
        """Return the force of one contact in N, >= 0, while the forces of all other contacts stay as they are.

        `gap` (m, negative where the tip is in the casing) is the gap at the end of the step with the present `force`
        (N). The gap grows by `compliance` (m/N, > 0) for each newton more. The law must hold between the returned force
        and gap + compliance (returned - force). The force must not grow with the gap, must be 0 where the gap is
        positive, and may not pull. `before` is the gap two steps earlier, for laws with REGARDS_RATE.

        The solver compiles this function and calls it in every sweep over the contacts of a step. The function may use
        arithmetic, `math` and constants of its own file. `numbers` is what the method `numbers` returns.
        """
