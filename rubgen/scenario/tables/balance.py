"""`[balance]`: shares of the runs that rub, of their classes of motion and of their severities, over the speed."""

import zlib
from dataclasses import dataclass
from itertools import accumulate, pairwise
from math import inf
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from rubgen.errors import UserError
from rubgen.machine.quantities import Share, StrictModel, about

MotionName = Literal["period-1", "period-k", "quasi-periodic", "chaotic"]
"""The classes of motion that a share may be asked of."""
NO_RUB, ANY_MOTION, OTHER_MOTION = "no rub", "", "other motion"
WEYL = (0.7548776662466927, 0.5698402909980532)
"""1/g and 1/g^2 with g^3 = g + 1: steps of an even sequence in two dimensions (Roberts, 2018)."""
NO_CANDIDATE = "balance: none of "
"""Beginning of the reason where no candidate of a run is in its class."""
MOST_BANDS = 16
MOST_TRIES = 10_000


@dataclass(frozen=True)
class Cell:
    """One class of runs of a balance, with its name and its share of all runs.

    `rub` is whether the runs rub, `motion` their class of motion ("" for any), `severities` the band of their
    contact_severity, without its upper end.
    """

    name: str
    share: float
    rub: bool
    motion: str = ANY_MOTION
    severities: tuple[float, float] = (0.0, inf)


class Balance(StrictModel):
    """`[balance]`: the share of the runs that rub, and the shares of their classes of motion and severities."""

    rub: Annotated[
        float,
        Field(ge=0, le=1),
        about("Share of the runs that rub. Without `[balance]` it is what the drawn values give."),
    ]
    motion: Annotated[
        dict[MotionName, Share] | None,
        Field(min_length=1),
        about(
            "Shares of the runs that rub by their class of motion. What is left up to 1 goes to all other classes. "
            "Without it classes come as they are drawn."
        ),
    ] = None
    severity_bounds: Annotated[
        tuple[Annotated[float, Field(gt=0, lt=1e6)], ...] | None,
        Field(min_length=1, max_length=MOST_BANDS),
        about(
            "Bounds of bands of contact_severity, ascending. Each band has the same share of the runs that rub. "
            "Without it severities come as they are drawn."
        ),
    ] = None
    speed_bands: Annotated[
        int,
        Field(ge=1, le=MOST_BANDS, strict=True),
        about(
            "Number of bands of the drawn speed, equally likely. The shares hold in every band, so that the speed does "
            "not tell the class."
        ),
    ] = 1
    tries: Annotated[
        int,
        Field(ge=1, le=MOST_TRIES, strict=True),
        about("Largest number of candidates of a run. Where none is in the class that is wanted, the run is refused."),
    ] = 200

    @model_validator(mode="after")
    def _is_possible(self) -> Self:
        total = sum((self.motion or {}).values())
        if total > 1 + 1e-9:
            raise ValueError(f"the shares of motion add up to {total:g}; lower them to 1 in all, or less")
        if self.rub == 0 and (self.motion or self.severity_bounds):
            raise ValueError("rub = 0: no run rubs, so motion and severity_bounds have no runs; raise rub")
        bounds = self.severity_bounds or ()
        if any(one >= other for one, other in pairwise(bounds)):
            raise ValueError(f"severity_bounds = {list(bounds)}: must ascend; sort them, each once")
        return self

    @property
    def needs_run(self) -> bool:
        """Whether the class of a candidate that rubs is known only after a short run."""
        return self.motion is not None or self.severity_bounds is not None

    @property
    def cells(self) -> tuple[Cell, ...]:
        """All classes of runs in fixed order: no rub, then each class of motion with each band of severity.

        Their shares add up to 1; a share may be 0. Every possible run is in one class. The speed is not part of a
        class: `place` chooses its band apart.
        """
        motions: list[tuple[str, float]] = list((self.motion or {}).items()) or [(ANY_MOTION, 1.0)]
        rest = 1 - sum(share for _, share in motions)
        motions += [(OTHER_MOTION, max(0.0, rest))] if self.motion else []
        bounds = (0.0, *(self.severity_bounds or ()), inf)
        bands = tuple(pairwise(bounds))
        cells = [Cell(NO_RUB, 1 - self.rub, rub=False)]
        for motion, share in motions:
            for band in bands:
                words = ["rub", motion, _band_name(band) if len(bands) > 1 else ""]
                name = ", ".join(word for word in words if word)
                cells.append(Cell(name, self.rub * share / len(bands), rub=True, motion=motion, severities=band))
        return tuple(cells)

    def place(self, seed: int, index: int) -> tuple[Cell, int]:
        """Return the cell of run number `index` and its band of the speed, from 0.

        They do not depend on the number of runs. Both follow from a Weyl sequence in two dimensions, whose start the
        seed draws. Of n successive runs each cell has its share to within some runs. A cell with the share 0 has no
        run.
        """
        start = np.random.default_rng([seed, zlib.crc32(b"balance")]).random(2)
        u, v = (float(np.modf(begin + index * step)[0]) for begin, step in zip(start, WEYL, strict=True))
        cells = [cell for cell in self.cells if cell.share > 1e-9]
        ends = accumulate(cell.share for cell in cells)
        cell = next((cell for cell, end in zip(cells, ends, strict=True) if u < end), cells[-1])
        return cell, int(v * self.speed_bands)

    def cell_of(self, *, rub: bool, motion: str = ANY_MOTION, severity: float = 0.0) -> int:
        """Return the index in `cells` of the class of a run with these labels.

        `severity` is the label contact_severity. Without a rub, `motion` and `severity` are not used. A `motion` that
        no cell names belongs to the cells of other motions.
        """
        asked = {ANY_MOTION, motion if motion in (self.motion or {}) else OTHER_MOTION}
        return next(
            number
            for number, cell in enumerate(self.cells)
            if cell.rub is rub and (not rub or (cell.motion in asked and _within(severity, cell.severities)))
        )


def check_balance(balance: Balance, profile: str, drawn: set[str], source: str) -> None:
    """Check the balance of a recipe against its speed.

    - balance: the table.
    - profile: the speed profile of the recipe.
    - drawn: the keys of `[vary]`.
    - source: beginning of messages.

    Raises UserError of one line for shares of motion or bands of severity at a changing speed, and for bands of a speed
    that is not drawn. Whether a class occurs at the drawn values is not checked.
    """
    if balance.needs_run and profile != "steady":
        key = "motion" if balance.motion else "severity_bounds"
        raise UserError(
            f'{source}: balance.{key}: with the profile "{profile}" a rub has no class of its own over the record; '
            "leave it out, or take a steady speed"
        )
    if balance.speed_bands > 1 and "speed_rpm" not in drawn:
        raise UserError(f"{source}: balance.speed_bands = {balance.speed_bands}: [vary] draws no speed_rpm; draw it")


def band_name(band: int, bands: int) -> str:
    """Return the end of a cell's name for band `band`, from 0, of `bands` bands of the speed; empty for one band."""
    return f", speed {band + 1} of {bands}" if bands > 1 else ""


def _within(severity: float, band: tuple[float, float]) -> bool:
    return band[0] <= severity < band[1]


def _band_name(band: tuple[float, float]) -> str:
    low, high = band
    if low == 0:
        return f"severity below {high:g}"
    return f"severity from {low:g}" if high == inf else f"severity {low:g} to {high:g}"
