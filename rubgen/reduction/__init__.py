"""Craig-Bampton reduction: the machine as a small system of the turning frame."""

from rubgen.reduction.model import CasingSurface, SpinningSystem, TurningForces
from rubgen.reduction.reduced import ReducedModel, reduce

__all__ = ["CasingSurface", "ReducedModel", "SpinningSystem", "TurningForces", "reduce"]
