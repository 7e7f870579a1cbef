"""The baselines as a table in Markdown, for the card of a data set, and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rubgen import __version__
from rubgen.baseline.baseline import LEAST_GAIN, NOTHING, SOLVED, Baseline
from rubgen.baseline.evaluate import FOLDS, SEEDS
from rubgen.baseline.tasks import TASKS


def table(found: Sequence[Baseline]) -> str:
    """Return a table of all scores as Markdown: a row for each task, metric and model, a column for each kind of score.

    A kind of score is for example "by group". A cell has mean ± standard deviation over the seeds, and is empty where
    there is no score. Below the table a line for each task says from how many windows its models learned. A further
    line for each marked task says what is wrong with it.
    """
    ways = list(dict.fromkeys(way for each in found for scores in each.scores.values() for way in scores))
    head = ["task", "metric", "model", *ways]
    rows = [
        [each.task, metric, model, *(_cell(scores.get(way, {}).get(metric)) for way in ways)]
        for each in found
        for metric in TASKS[each.task].metrics
        for model, scores in each.scores.items()
    ]
    lines = ["| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)]
    sizes = [f"- {each.task}: learned from {each.windows} windows of {each.groups} groups" for each in found]
    marks = [f"- {each.task}: {each.mark}" for each in found if each.mark]
    return "\n".join([*lines, "", *sizes, *marks])


def document(name: str, manifest_sha256: str, found: Sequence[Baseline], reasons: dict[str, str]) -> dict[str, Any]:
    """Return the content of baselines.json.

    - name, manifest_sha256: of the data set.
    - found: the scores.
    - reasons: why the other tasks are not possible, by task.
    """
    return {
        "data_set": name,
        "manifest_sha256": manifest_sha256,
        "rubgen": __version__,
        "folds": FOLDS,
        "seeds": SEEDS,
        "one_threshold_solves_above": SOLVED,
        "nothing_learned_below": NOTHING,
        "least_gain_over_the_majority": LEAST_GAIN,
        "tasks": [asdict(each) for each in found],
        "not_possible": reasons,
    }


def _cell(score: tuple[float, float] | None) -> str:
    return "" if score is None else f"{score[0]:.2f} ± {score[1]:.2f}"
