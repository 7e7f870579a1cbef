"""`docs/sensitivity.md` from the results."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from textwrap import fill

from validation.markdown import folded, table
from validation.sensitivity.cases import CASES, STUDIES, Study
from validation.sensitivity.figures import QUANTITIES
from validation.sensitivity.halving import (
    EQUAL_LABELS,
    IMPULSE_TOLERANCE,
    SPEEDS_RPM,
    STEPS,
    Pair,
    equal_share,
)
from validation.sensitivity.outcome import Outcome
from validation.sensitivity.remarks import FOLLOWS, INTRODUCTION, REMARKS
from validation.sensitivity.results import Results, change, of_case

COMMAND = "python -m validation.sensitivity"


def page(results: Mapping[str, Results], pairs: Sequence[Pair]) -> str:
    """The page: what was tried, what follows, then each study that has results with its figure and table."""
    parts = [INTRODUCTION, FOLLOWS]
    if pairs:
        parts.append(_halving(pairs))
    parts += [_section(study, results[study.name]) for study in STUDIES if study.name in results]
    missing = [study.name for study in STUDIES if study.name not in results] + ([] if pairs else ["halving"])
    if missing:
        parts.append(f"Not run yet: {', '.join(missing)}; `{COMMAND} {' '.join(missing)}` completes them.")
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _section(study: Study, results: Results) -> str:
    lines = [f"## {study.quantity}", f"![{study.quantity}](sensitivity-{study.name}.png)", REMARKS[study.name].strip()]
    lines.append(_wrapped(_equal_labels(study, results)))
    rows = [_row(study, results, value, name) for value in _values(results) for name in CASES]
    lines.append(folded(f"{len(rows)} runs: motion, zones, impulse and orders of each", table(_COLUMNS, rows)))
    if study.model:
        header = [
            "value",
            "DoF",
            "growth without contact, um",
            "critical speed, rev/min",
            "blisk, first 42",
            "last casing mode, Hz",
        ]
        lines.append(table(header, [_model_row(study, results, value) for value in _values(results)]))
    return "\n\n".join(lines)


def _values(results: Results) -> list[int]:
    return sorted({result.value for result in results}, key=lambda value: value or math.inf)


def _equal_labels(study: Study, results: Results) -> str:
    """How many runs have the label of the same case at the default, and which have not."""
    default = study.default if study.default in _values(results) else study.yardstick
    compared = [r for r in results if r.value != default]
    other = [r for r in compared if r.outcome.label != of_case(results, r.case)[default].label]
    sentence = f"{len(compared) - len(other)} of {len(compared)} runs have the same class of motion as at the default."
    named = "; ".join(f"{r.case} at {study.text(r.value)}: {r.outcome.label}" for r in other)
    return f"{sentence} Others: {named}." if named else sentence


_COLUMNS = ["value", "run", "motion", "zones", "impulse a turn, N s", *(f"{name}, %" for name in QUANTITIES)]


def _row(study: Study, results: Results, value: int, name: str) -> list[str]:
    outcomes = of_case(results, name)
    outcome, yardstick = outcomes[value], outcomes[_yardstick(study, results)]
    raised = f" ({outcome.steps_per_turn} steps)" if _raised(study, outcome, value) else ""
    changes = [_percent(change(outcome, yardstick, read)) for read in QUANTITIES.values()]
    return [study.text(value) + raised, name, outcome.label, _zones(outcome), _impulse(outcome), *changes]


def _yardstick(study: Study, results: Results) -> int:
    values = _values(results)
    return study.yardstick if study.yardstick in values else values[-1]


def _raised(study: Study, outcome: Outcome, value: int) -> bool:
    """Whether stability raised the steps a turn above what was asked."""
    return outcome.steps_per_turn != (value if study.name == "steps" else STEPS)


def _model_row(study: Study, results: Results, value: int) -> list[str]:
    outcomes = of_case(results, next(iter(CASES)))
    outcome, yardstick = outcomes[value], outcomes[_yardstick(study, results)]
    pairs = zip(outcome.blisk_frequencies_hz, yardstick.blisk_frequencies_hz, strict=True)
    worst = max((hz / reference - 1 for hz, reference in pairs), key=abs)
    growth, critical = f"{1e6 * outcome.growth:.2f}", f"{outcome.critical_speed_rpm:.2f}"
    return [study.text(value), str(outcome.dof), growth, critical, f"{worst:+.1e}", f"{outcome.highest_casing_hz:.2f}"]


def _halving(pairs: Sequence[Pair]) -> str:
    done = (
        ""
        if len(pairs) == len(SPEEDS_RPM)
        else (
            f"Only {len(pairs)} of the {len(SPEEDS_RPM)} speeds are finished; `{COMMAND} halving` completes them.\n\n"
        )
    )
    rubbing = [pair for pair in pairs if pair.whole.rub or pair.half.rub]
    changes = {pair.speed_rpm: pair.impulse_change for pair in pairs if pair.impulse_change is not None}
    beyond = {speed: value for speed, value in changes.items() if abs(value) > IMPULSE_TOLERANCE}
    text = [
        "## Half the step",
        "![Impulse over speed with either step](sensitivity-halving.png)",
        REMARKS["halving"].strip(),
        done + _wrapped(_equal_sentence(pairs, rubbing)),
        _wrapped(_impulse_sentence(changes, beyond)),
    ]
    others = [pair for pair in pairs if not pair.equal]
    if others:
        text += [_wrapped(_others_sentence(others)), _others(others)]
    return "\n\n".join(text)


def _equal_sentence(pairs: Sequence[Pair], rubbing: Sequence[Pair]) -> str:
    equal = [pair for pair in pairs if pair.equal]
    zones = sum(pair.equal_zones for pair in equal)
    return (
        f"Labels (status, rub, motion, period) are equal at {len(equal)} of {len(pairs)} speeds, "
        f"{100 * equal_share(pairs):.1f} % (required: {100 * EQUAL_LABELS:.0f} %). Among the {len(rubbing)} speeds "
        f"with rub they are equal at {_share(rubbing)}. The number of zones and their symmetry are also equal at "
        f"{zones} speeds."
    )


def _share(pairs: Sequence[Pair]) -> str:
    return f"{sum(pair.equal for pair in pairs)} ({100 * equal_share(pairs):.1f} %)" if pairs else "none"


def _impulse_sentence(changes: Mapping[float, float], beyond: Mapping[float, float]) -> str:
    if not changes:
        return "No speed has a period-1 rub with either step."
    values = sorted(abs(value) for value in changes.values())
    start = (
        f"At {len(values)} speeds the motion is period-1 in contact with both steps. There the impulse changes by "
        f"{100 * values[len(values) // 2]:.2f} % in the median and by {100 * values[-1]:.2f} % at most"
    )
    named = ", ".join(f"{speed:.0f} rev/min {100 * value:+.1f} %" for speed, value in beyond.items())
    return f"{start}; beyond {100 * IMPULSE_TOLERANCE:.0f} %: {named}." if beyond else f"{start}."


def _others_sentence(others: Sequence[Pair]) -> str:
    themselves = sum(pair.changes_by_itself for pair in others)
    return (
        f"The table shows the {len(others)} other speeds with their indicators (1,024 / 2,048 steps). `next record` is "
        f"the motion of the next 500 turns, at 1,024 steps: at {themselves} of these speeds the label changes without "
        "a change of the step."
    )


def _others(pairs: Sequence[Pair]) -> str:
    header = [
        "rev/min",
        "motion",
        "next record",
        "K blisk",
        "K casing",
        "stray blisk",
        "stray casing",
        "exponent a turn",
        "zones",
        "impulse, N s",
    ]
    rows = []
    for pair in pairs:
        both = (pair.whole, pair.half)
        rows.append([
            f"{pair.speed_rpm:.0f}",
            " / ".join(run.label for run in both),
            pair.later.label if pair.later else "-",
            " / ".join(f"{run.indicator_blisk:.2f}" for run in both),
            " / ".join(f"{run.indicator_casing:.2f}" for run in both),
            " / ".join(f"{run.stray_blisk:.1e}" for run in both),
            " / ".join(f"{run.stray_casing:.1e}" for run in both),
            " / ".join(f"{run.exponent:+.3f} +- {run.exponent_error:.3f}" for run in both),
            " / ".join(_zones(run) for run in both),
            " / ".join(f"{run.impulse:.4f}" for run in both),
        ])  # fmt: skip
    return table(header, rows)


def _zones(outcome: Outcome) -> str:
    if not outcome.zones:
        return "-"
    return f"{outcome.zones} {'equal' if outcome.symmetric else 'unequal'}"


def _impulse(outcome: Outcome) -> str:
    if not outcome.motion:
        return "-"
    error = f" +- {outcome.impulse_error:.4f}" if outcome.impulse_error > 5e-5 else ""
    return f"{outcome.impulse:.4f}{error}"


def _percent(value: float) -> str:
    return f"{100 * value:+.2f}" if math.isfinite(value) else "-"


def _wrapped(sentence: str) -> str:
    return fill(sentence, 120, break_on_hyphens=False, break_long_words=False)
