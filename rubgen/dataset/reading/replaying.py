"""The replay of a run: read from an MCAP file, or simulated again from the scenario in its data set."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from rubgen.arrays import FloatArray
from rubgen.brief import in_shell
from rubgen.dataset.layout import Layout
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.rows import remember
from rubgen.errors import UserError
from rubgen.io.mcap.messages import CONTACT_FIELDS
from rubgen.io.mcap.read import McapRun
from rubgen.io.parquet.read import read_table
from rubgen.io.parquet.words import with_words
from rubgen.measurement.blade_tip_timing import TipTimes
from rubgen.measurement.chain import start_seconds
from rubgen.measurement.channel import NUMBERS, TEXTS, Channel, Recording
from rubgen.measurement.motion import ContactIntervals
from rubgen.scenario import Scenario
from rubgen.scenario.load import check_recipe
from rubgen.scenario.run_id import index_of
from rubgen.viz.replay import Replay, sorted_touches

ONLY_READ: dict[str, bool | int | float | str | list[str]] = {
    "enable_external_access": False,
    "lock_configuration": True,
}
"""Settings of duckdb: a condition can read only the table of runs, and neither a file nor a setting."""
MOST_MEANT = 5
"""Number of similar columns in the message about a mistaken condition."""


@dataclass(frozen=True, kw_only=True)
class FoundReplay:
    """A replay, with remarks for the user: whether the run was simulated again, and what a damaged file has lost."""

    replay: Replay
    remarks: tuple[str, ...] = ()


def find_replay(source: Path, run_id: str | None = None, where: str | None = None) -> FoundReplay:
    """Find the run that the user wants to see. Return its replay, with remarks for the user.

    - source: an MCAP file, which contains one run, or the directory of a data set.
    - run_id: name of a good run (status ok) of the set.
    - where: a condition in duckdb's SQL, without the word WHERE, on the columns of `runs.parquet`, with words for
      classes: motion = 'chaotic'. The first good run by name that meets it is taken.

    Give at most one of `run_id` and `where`, and none of them with a file. Without both the first good run is taken. A
    run of the set without an MCAP file is simulated again. The remarks say whether it was, what a damaged file has
    lost, and how many runs met the condition if several did. Raises UserError where the source or the run does not
    exist, the run failed, a choice does not fit, no good run meets the condition, the condition is not valid, or the
    file does not fit the set or this version.
    """
    if source.is_dir():
        return _from_data_set(source, run_id, where)
    if run_id is not None or where is not None:
        raise UserError(f"{source}: is one run, not a data set; leave out {run_id or '--where'}")
    if source.suffix == ".rrd" and source.exists():
        raise UserError(f"{source}: .rrd files are for the Rerun viewer alone; open it with: rerun {in_shell(source)}")
    return replay_of_mcap(source)


def replay_of_mcap(path: Path) -> FoundReplay:
    """Make the replay of the run in an MCAP file. The remarks name the content that a damaged file has lost.

    A file without a motion track gives a replay without frames. Raises UserError where the file is missing or cannot be
    read even in part, or where this version of rubgen cannot read its scenario.
    """
    from rubgen.io.mcap.read import salvage_mcap

    run, lost = salvage_mcap(path)
    remarks = tuple(f"{path} is damaged; lost: {piece}" for piece in lost)
    return FoundReplay(replay=replay_of_recorded(run, source=str(path)), remarks=remarks)


def replay_of_recorded(run: McapRun, *, source: str = "the file") -> Replay:
    """Make the replay of a run that was read from an MCAP file. `source` names the file in messages.

    Raises UserError where this version of rubgen cannot read the run's scenario.
    """
    try:
        scenario = TypeAdapter(Scenario).validate_python(run.scenario)
    except ValidationError as error:
        where = ".".join(str(part) for part in error.errors()[0]["loc"])
        raise UserError(f"{source}: its scenario is of another rubgen ({where}); generate it again") from None
    channels = {name: _channel(name, values, run) for name, values in run.signals.items()}
    recording = Recording(
        sample_rate_hz=run.sample_rate_hz,
        rotation_angle=float(np.mod(-run.once_per_rev[:1].sum() * scenario.operation.speed_rad_per_s, 2 * np.pi)),
        channels=channels,
        once_per_rev=run.once_per_rev,
        start_seconds=_first_sample(scenario),
        tip_timing={name: _timing(columns) for name, columns in run.tip_timing.items()},
    )
    return Replay(
        scenario=scenario,
        labels=run.labels,
        recording=recording,
        touches=_touches(run.contacts),
        frames=run.frames,
        motion_classes=run.motion_classes,
    )


def find_runs(data: DataSet, where: str) -> list[str]:
    """Return the names of the good runs that meet the condition `where`, in order of the names.

    `where` is SQL on the columns of `runs.parquet` with words for classes, such as motion = 'chaotic', without the word
    WHERE. Raises UserError, with similar columns, for a condition that duckdb does not understand.
    """
    import duckdb

    runs = with_words(read_table(data.layout.runs))
    query = f"SELECT run_id FROM runs WHERE status = 'ok' AND ({where}\n) ORDER BY run_id"  # noqa: S608
    try:
        with duckdb.connect(config=ONLY_READ) as connection:
            connection.register("runs", runs)
            return [str(row[0]) for row in connection.execute(query).fetchall()]
    except duckdb.Error as error:
        reason = str(error).splitlines()[0]
        told = f"columns are those of {data.layout.card}{_meant(where, data.runs.columns)}"
        raise UserError(f"--where {where!r}: {reason}; {told}") from None


def _meant(where: str, columns: Iterable[str]) -> str:
    """Name columns similar to the unknown words of a condition, because a set has hundreds of columns."""
    known = set(columns)
    words = [word for word in re.findall(r"[A-Za-z_]\w+", where) if word not in known]
    near = [name for word in words for name in get_close_matches(word, known, n=3)]
    return f", such as {', '.join(near[:MOST_MEANT])}" if near else ""


def scenario_of(data: DataSet, run_id: str) -> Scenario:
    """Return the scenario of a run, drawn from the recipe and machine in the manifest."""
    whole, row, number = data.recipe, data.row(run_id), index_of(run_id)
    first, recipe = max((each for each in whole.sources if each[0] <= number), key=lambda each: each[0])
    remember(recipe, number - first, row)
    return whole.scenario(number)


def _from_data_set(directory: Path, run_id: str | None, where: str | None) -> FoundReplay:
    data = DataSet(directory)
    chosen, remarks = _choose(data, run_id, where)
    path = Layout(directory).export("mcap", chosen)
    if path.exists():
        found = replay_of_mcap(path)
        if found.replay.scenario.run_id != chosen:
            raise UserError(f"{path}: holds {found.replay.scenario.run_id}; see `rubgen verify {in_shell(directory)}`")
        return FoundReplay(replay=found.replay, remarks=(*remarks, *found.remarks))
    from rubgen.pipeline import simulate
    from rubgen.viz.replay import replay_of

    for _, recipe in data.recipe.sources:
        check_recipe(recipe, str(data.layout.manifest))
    run = simulate(scenario_of(data, chosen))
    return FoundReplay(replay=replay_of(run), remarks=(*remarks, f"{chosen} has no MCAP file and was simulated again"))


def _choose(data: DataSet, run_id: str | None, where: str | None) -> tuple[str, tuple[str, ...]]:
    if run_id is not None and where is not None:
        raise UserError(f"{run_id} and --where: give a run or a condition, not both")
    if run_id is not None:
        data.check_has_signals(run_id)
        return run_id, ()
    found = find_runs(data, where) if where else [str(run_id) for run_id in data.ok.index]
    if not found:
        what = f"meets {where!r}" if where else "is good"
        raise UserError(f"{data.layout.root}: no run {what}; see `rubgen info {in_shell(data.layout.root)}`")
    more = f"{len(found)} runs meet the condition, {found[0]} is shown" if where and len(found) > 1 else ""
    return found[0], (more,) if more else ()


def _first_sample(scenario: Scenario) -> float:
    """Return the time of the first sample from the start of the record in s, to one step."""
    operation = scenario.operation
    record = operation.rotation.time_of(2 * np.pi * operation.recorded_turns)
    steps = operation.recorded_turns * operation.steps_per_turn
    return start_seconds(scenario.sensing, scenario.signal_seconds, steps=steps, dt=record / steps)


def _channel(name: str, values: Any, run: McapRun) -> Channel:
    described = run.channels[name]
    facts: dict[str, Any] = {key: described[key] for key in TEXTS}
    facts |= {key: float(described.get(key, "0")) for key in NUMBERS}
    return Channel(name=name, values=values, clean=run.clean.get(name), **facts)


def _timing(columns: dict[str, FloatArray]) -> TipTimes:
    return TipTimes(
        time=columns["time_s"],
        blade=columns["blade"].astype(np.int64),
        true_displacement=columns["true_displacement_m"],
    )


def _touches(contacts: dict[str, FloatArray]) -> ContactIntervals:
    values: dict[str, Any] = {field: contacts[name] for name, field in CONTACT_FIELDS.items()}
    return sorted_touches(ContactIntervals(**values | {"blade": contacts["blade"].astype(np.int64)}))
