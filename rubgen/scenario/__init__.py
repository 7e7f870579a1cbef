"""What is varied: scenarios of single runs, and the recipes that draw them."""

from rubgen.scenario.contact_laws.contact_law import ContactLaw, Liner
from rubgen.scenario.load import load_recipe, parse_recipe
from rubgen.scenario.make import make_scenario
from rubgen.scenario.recipe import Recipe
from rubgen.scenario.scenario import Labelling, Operation, Reduction, Scenario, Sensing

__all__ = [
    "ContactLaw",
    "Labelling",
    "Liner",
    "Operation",
    "Recipe",
    "Reduction",
    "Scenario",
    "Sensing",
    "load_recipe",
    "make_scenario",
    "parse_recipe",
]
