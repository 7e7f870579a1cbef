"""What is varied: scenarios of single runs, and the recipes that draw them."""

from rubgen.scenario.scenario import ContactLaw, Operation, Reduction, Scenario, Sensing

__all__ = ["ContactLaw", "Operation", "Reduction", "Scenario", "Sensing"]
