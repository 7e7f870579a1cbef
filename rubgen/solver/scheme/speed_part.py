"""The part of the scheme that follows the speed."""

from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.geometry_kernels import Tips
from rubgen.solver.scheme.free_step_kernels import Scheme
from rubgen.solver.scheme.model_kernels import EnergyTerms
from rubgen.solver.supports.support_kernels import Support


class SpeedPart(NamedTuple):
    """The fields of a `Model` that depend on the speed, each as in `Model`."""

    tips: Tips
    scheme: Scheme
    tip_compliance: FloatArray
    casing_compliance: FloatArray
    support: Support
    energy: EnergyTerms
