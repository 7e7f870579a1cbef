"""The results of a study: made from its runs, kept as JSON, read back for the page."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rubgen.scenario import Scenario
from validation.sensitivity.cases import CASES, Study, case
from validation.sensitivity.halving import Pair
from validation.sensitivity.outcome import Outcome


@dataclass(frozen=True, kw_only=True)
class Result:
    """The outcome of one case with one value of the number that a study varies."""

    case: str
    value: int
    outcome: Outcome


Results = list[Result]


def vary_number(
    study: Study,
    values: Sequence[int],
    outcome: Callable[[Scenario], Outcome],
    shorter: Callable[[Scenario], Scenario],
) -> Results:
    """The results of a study at these values for every case; `shorter` may cut the turns before the value is set."""
    return [
        Result(case=name, value=value, outcome=outcome(study.apply(shorter(case(name)), value)))
        for value in values
        for name in CASES
    ]


def of_case(results: Results, name: str) -> dict[int, Outcome]:
    """The outcomes of one case by value."""
    return {result.value: result.outcome for result in results if result.case == name}


def change(outcome: Outcome, yardstick: Outcome, read: Callable[[Outcome], float]) -> float:
    """Relative change of what `read` gives against the yardstick; NaN where either run failed or the yardstick is 0."""
    try:
        reference = read(yardstick)
        return read(outcome) / reference - 1 if reference else math.nan
    except IndexError:  # a failed run has no orders
        return math.nan


def write_results(results: Results, path: Path) -> None:
    """Write the results of a study as a JSON list of `case`, `value` and the fields of `Outcome`."""
    _write([{"case": r.case, "value": r.value} | r.outcome.as_dict() for r in results], path)


def read_results(path: Path) -> Results:
    """The results of a study as `write_results` wrote them."""
    rows = json.loads(path.read_text(encoding="utf-8"))
    return [Result(case=row.pop("case"), value=row.pop("value"), outcome=_outcome(row)) for row in rows]


def write_pairs(pairs: Sequence[Pair], path: Path) -> None:
    """Write pairs as a JSON list of `speed_rpm`, `whole`, `half` and `later`."""
    _write([asdict(pair) for pair in pairs], path)


def read_pairs(path: Path) -> list[Pair]:
    """The pairs as `write_pairs` wrote them."""
    return [
        Pair(
            speed_rpm=row["speed_rpm"],
            whole=_outcome(row["whole"]),
            half=_outcome(row["half"]),
            later=_outcome(row["later"]) if row["later"] else None,
        )
        for row in json.loads(path.read_text(encoding="utf-8"))
    ]


def _write(rows: list[dict[str, object]], path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(_plain(rows), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _plain(value: object) -> object:
    """JSON has no NaN: None stands for it."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in value.items()}
    return [_plain(inner) for inner in value] if isinstance(value, list) else value


def _outcome(row: dict[str, object]) -> Outcome:
    absent = {name: math.nan for name, value in row.items() if value is None and name not in ("period", "symmetric")}
    return Outcome(**(row | absent))  # type: ignore[arg-type]
