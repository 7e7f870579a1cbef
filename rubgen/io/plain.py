"""One place from which every writer takes labels and scenario as JSON-ready dictionaries."""

from __future__ import annotations

from rubgen.labels.plain import labels_dict
from rubgen.scenario.plain import scenario_dict

__all__ = ["labels_dict", "scenario_dict"]
