"""Craig-Bampton reduction: the machine as a small system of the turning frame."""

from rubgen.reduction.casing import largest_casing_order
from rubgen.reduction.model import CasingSurface, SpinningSystem
from rubgen.reduction.reduced import ReducedModel, reduce

__all__ = ["CasingSurface", "ReducedModel", "SpinningSystem", "largest_casing_order", "reduce"]
