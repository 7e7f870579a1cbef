"""`[splits]` of a recipe: which machines are in which split, and what a split draws differently."""

import zlib
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Discriminator, Field, Tag

from rubgen.machine.quantities import MOST_RUNS, Share, StrictModel
from rubgen.machine.sentences import SPLIT_NAME
from rubgen.scenario.surroundings import SurroundingsTable
from rubgen.scenario.tables.machines import MachineTable, MachineVary, merged
from rubgen.scenario.tables.run import Profile
from rubgen.scenario.tables.vary import Vary

RESERVED = "all"
"""`load_dataset(split="all")` means every split."""
ONE_SPLIT = ("train",)
"""The splits of a recipe without `[splits]`."""
GOLDEN = (5**0.5 - 1) / 2


class SplitTable(StrictModel):
    """`[splits.NAME]`: a split with its share of the machines, and the keys in which it differs from the recipe."""

    share: Annotated[Share, Field(description="Share of the machines. All shares add up to 1.")]
    machines: Annotated[
        MachineVary | None,
        Field(description="Keys of `[machines.vary]` that replace those of the recipe for the machines of this split."),
    ] = None
    vary: Annotated[
        Vary | None,
        Field(description="Keys of `[vary]` that replace those of the recipe for the runs of this split."),
    ] = None
    surroundings: Annotated[
        SurroundingsTable | None,
        Field(description="Surroundings in place of the recipe's, which must have some too."),
    ] = None
    operation: Annotated[
        Profile | None, Field(description="Profile of the speed in place of the recipe's whole `[operation]`.")
    ] = None
    sensors: Annotated[
        str | None,
        Field(
            min_length=1,
            description="Sensor set in place of the recipe's, with the same sensors at the same places: names, kinds "
            "and places make the columns. Noise, bandwidth, range and faults of the chain may differ.",
        ),
    ] = None

    @property
    def changes(self) -> bool:
        """Whether the split has keys besides its share."""
        return bool(self.model_fields_set - {"share"})


def _checked(splits: dict[str, float | SplitTable]) -> dict[str, float | SplitTable]:
    if not splits:
        raise ValueError("needs at least one split with its share; add train = 1.0 or leave the table out")
    if RESERVED in splits:
        raise ValueError(f"{RESERVED}: readers call every split together so; take another name")
    total = sum(map(share_of, splits.values()))
    if abs(total - 1) > 1e-9:
        listed = " + ".join(f"{share_of(split):g}" for split in splits.values())
        raise ValueError(f"the shares add up to {total:g}, {listed}; change them so that they add up to 1")
    return splits


def _kind(split: object) -> str:
    """Return the tag of the union; in angle brackets, so that no key of a recipe has the same name."""
    return "<table>" if isinstance(split, Mapping | SplitTable) else "<share>"


SplitName = Annotated[str, Field(pattern=SPLIT_NAME)]
Split = Annotated[Annotated[Share, Tag("<share>")] | Annotated[SplitTable, Tag("<table>")], Discriminator(_kind)]
Splits = Annotated[dict[SplitName, Split], AfterValidator(_checked)]


def share_of(split: float | SplitTable) -> float:
    """Return the share of a split, in [0, 1]. In a recipe a split is its share, or a table with the key `share`."""
    return split.share if isinstance(split, SplitTable) else split


def split_of_machine(splits: Mapping[str, Any], seed: int, number: int) -> str:
    """Return the name of the split of machine `number`. It does not depend on the number of machines.

    `splits` is the recipe's table `[splits]` and `seed` the recipe's seed.

    u = frac(u0 + number (sqrt(5) - 1) / 2), with u0 drawn by the seed, lies in the split's interval of [0, 1). Of n
    successive machines each split has its share to within some machines (three-distance theorem). The same holds for
    the machines of each file where the recipe has several.
    """
    start = np.random.default_rng([seed, zlib.crc32(b"splits")]).random()
    place, end = (start + number * GOLDEN) % 1.0, 0.0
    for name, split in splits.items():
        end += share_of(split)
        if place < end:
            return name
    return name


def enough_machines(splits: Mapping[str, Any], seed: int, name: str) -> int | None:
    """Return the least number of machines of which one is in the split `name`; None if that is above MOST_RUNS.

    `splits` is the recipe's table `[splits]` and `seed` the recipe's seed.
    """
    return next((number + 1 for number in range(MOST_RUNS) if split_of_machine(splits, seed, number) == name), None)


def changes_of(recipe: Any, split: SplitTable) -> dict[str, Any]:
    """Return the fields of the recipe that the split replaces, by field name, with their new values."""
    changes: dict[str, Any] = {key: getattr(split, key) for key in ("surroundings", "operation") if getattr(split, key)}
    if split.machines:
        table = recipe.machines or MachineTable()
        changes["machines"] = table.model_copy(update={"vary": merged(table.vary, split.machines)})
    if split.vary:
        changes["vary"] = merged(recipe.vary, split.vary)
    if split.sensors:
        changes["sensors"] = recipe.sensors.model_copy(update={"set": split.sensors})
    return changes
