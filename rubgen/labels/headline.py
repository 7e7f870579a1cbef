"""Say in one line what a run is: whether and from which speed it rubs, and how it moves."""

from collections.abc import Mapping
from typing import Any


def headline(labels: Mapping[str, Any], profile: str) -> str:
    """Return one line of labels, such as `partial rub, chaotic` or `run-up: rub from 7,410 rev/min`.

    While the speed changes there is no class of motion of the whole record; the speeds of first and last touch are
    known, and the labels of changes and windows say what the motion is in between. A rub that is there at the start or
    at the end of the record has no onset or no end within it.

    - labels: of one good run by their public names.
    - profile: of its speed: steady, run-up, coast-down or fluctuating.
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
