"""Say in one line what a run is: whether and from which speed it rubs, and how it moves."""

from collections.abc import Mapping
from typing import Any


def headline(labels: Mapping[str, Any], profile: str) -> str:
    """Return one line about a run, such as `partial rub, chaotic` or `run-up: rub from 7,410 rev/min`.

    - labels: the labels of one run with status ok, by their public names, classes as words.
    - profile: its speed profile: steady, run-up, coast-down or fluctuating.

    If the speed changes, the line has no class of motion, because the class may change within the record. It has the
    speeds of the first and the last touch instead. The first speed is left out if the run rubs at the start of the
    record, the last speed if it rubs at the end. If it rubs at both, the line says so without speeds.
    """
    if profile == "steady":
        rub = f"{labels['rub_extent']} rub" if labels["rub"] else "no rub"
        motion = labels["motion"]
        return f"{rub}, {'motion undecided' if motion == 'undecided' else motion}"
    if not labels["rub"]:
        return f"{profile}: no rub"
    onset, end = (f"{labels[name]:,.0f}" for name in ("onset_speed_rpm", "end_of_rub_speed_rpm"))
    before, after = bool(labels["change_rub"][0]), bool(labels["change_rub"][-1])
    where = {
        (True, True): "rub at its start and at its end",
        (True, False): f"rub until {end} rev/min",
        (False, True): f"rub from {onset} rev/min",
        (False, False): f"rub from {onset} to {end} rev/min",
    }
    return f"{profile}: {where[before, after]}"
