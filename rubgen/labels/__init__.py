"""Labels: what the dynamics really did, from the true response alone."""

from rubgen.labels.classes import MOTION_CLASSES
from rubgen.labels.label import label
from rubgen.labels.labels import Labels, Motion

__all__ = ["MOTION_CLASSES", "Labels", "Motion", "label"]
