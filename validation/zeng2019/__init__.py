"""Zeng et al. (2019) done again: every figure and statement, with a verdict. See `docs/zeng2019.md`."""

from validation.zeng2019.fitting.fit import Fitted, fit
from validation.zeng2019.reproducing import Reproduced, reproduce

__all__ = ["Fitted", "Reproduced", "fit", "reproduce"]
