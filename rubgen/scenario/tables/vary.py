"""`[vary]` of a recipe: what each run draws."""

from typing import Annotated, Any

from pydantic import Field, create_model

from rubgen.machine.descriptions import draws
from rubgen.machine.quantities import StrictModel
from rubgen.scenario.distributions import Distribution
from rubgen.scenario.vary import DRAWN

_FIELDS: dict[str, Any] = {
    entry.key: (
        Annotated[Distribution | None, Field(description=entry.about, json_schema_extra=draws(entry.quantity))],
        None,
    )
    for entry in DRAWN
}
Vary = create_model(
    "Vary",
    __base__=StrictModel,
    __doc__="`[vary]`: a number fixes a value, a table draws it.",
    **_FIELDS,
)
