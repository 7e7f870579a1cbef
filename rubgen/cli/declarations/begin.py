"""Declare the commands before a data set: what comes with rubgen, files to begin with, a plan."""

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from rubgen.cli.options import Force, Json, RecipeFile, here, option, whole, whole_number


def list_offered(*, json: Json = False) -> int:
    """Print the recipes, machines, sensor sets and faults that come with rubgen."""
    from rubgen.cli.commands.starting import list_command

    return list_command(as_json=json)


def init(
    kind: Annotated[Literal["recipe", "machine", "sensors"], option("What to begin.")],
    file: Annotated[Path | None, here("File to write; the kind with the ending .toml when not given.")] = None,
    /,
    *,
    origin: Annotated[
        str | None, Parameter(name="--from", help="A recipe, machine or sensor set of rubgen list to begin from.")
    ] = None,
) -> int:
    """Write a file to begin with: a recipe, machine or sensor set of rubgen, with a comment for each key."""
    from rubgen.cli.commands.starting import init_command

    return init_command(kind, origin, file)


def plan(
    recipe: RecipeFile = None,
    /,
    *,
    runs: Annotated[int | None, whole_number("Number of runs, instead of the recipe's.")] = None,
    tries: Annotated[
        int,
        Parameter(
            name="--try", converter=whole, help="Number of runs to simulate: their classes, and time and sizes here."
        ),
    ] = 0,
    out: Annotated[Path | None, here("Picture to write: .png, .svg or .pdf.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Print what a recipe draws, which runs can rub, which values are refused, and minutes and MB of its data set.

    The data set is not made. Up to 64 of its runs are looked at. Exit 1 where one of them, or a scenario at an extreme
    value of the recipe, is refused.
    """
    from rubgen.cli.commands.planning import plan_command

    return plan_command(recipe, runs, tries, out, force=force, as_json=json)
