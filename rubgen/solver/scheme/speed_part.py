"""What of the scheme follows the speed."""

from __future__ import annotations

from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.geometry_kernels import Tips
from rubgen.solver.scheme.energy_kernels import Book
from rubgen.solver.scheme.free_step_kernels import Scheme
from rubgen.solver.scheme.support_kernels import Support


class SpeedPart(NamedTuple):
    """What of a stepper follows the speed."""

    tips: Tips
    scheme: Scheme
    compliances: tuple[FloatArray, FloatArray]
    book: Book
    support: Support
