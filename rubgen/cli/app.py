"""Declare the commands and their options. Each function imports its work when it is called."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import App, Parameter, Token

from rubgen import __version__
from rubgen.cli.option_texts import TEXTS
from rubgen.errors import UserError
from rubgen.format_names import ENDINGS

app = App(
    name="rubgen",
    help="Labelled blade-rub data from a finite-element blisk in a flexible oval casing.",
    version=__version__,
    version_flags=["--version"],
    help_format="plaintext",
    suppress_keyboard_interrupt=False,
)


def _option(text: str) -> Parameter:
    return Parameter(help=text)


def _whole_number(text: str) -> Parameter:
    return Parameter(help=text, converter=_whole)


def _whole(_type: Any, tokens: Sequence[Token]) -> int:
    """Return the integer as written. Without this converter cyclopts would truncate 2.5 to 2."""
    return int(tokens[0].value)


def _place(text: str) -> Parameter:
    return Parameter(help=text, converter=_as_written)


def _local(_type: Any, tokens: Sequence[Token]) -> Path:
    text = tokens[0].value
    if "://" in text:
        raise UserError(f"{text}: this command needs a directory; bring the files there first")
    return Path(text)


def _as_written(_type: Any, tokens: Sequence[Token]) -> Path | str:
    """Return a URL as it was written: a Path would make one slash of two."""
    text = tokens[0].value
    return text if "://" in text else Path(text)


Json = Annotated[bool, Parameter(name="--json", negative=(), help="Print JSON, for programs.")]
MachineName = Annotated[str, _option("Name of a preset, or path of a machine TOML.")]
RecipeFile = Annotated[
    Path | None, _option("Recipe TOML, or a name of rubgen list; without it zeng2019-mini of 32 runs.")
]
Force = Annotated[bool, Parameter(negative=(), help="Replace a file that is there.")]
Directory = Annotated[Path, Parameter(help="Directory of a data set.", converter=_local)]
Place = Annotated[Path, _place("Directory of a data set, or its URL such as s3://bucket/set.")]


@app.command
def generate(
    recipe: RecipeFile = None,
    /,
    *,
    out: Annotated[
        Path, _place("New or empty directory, or one of the same recipe, which is then completed; or a URL for one.")
    ],
    runs: Annotated[
        int | None, _whole_number("Number of runs, instead of the recipe's; a larger one lets a finished set grow.")
    ] = None,
    workers: Annotated[int | None, _whole_number("Number of processes; the number of cores when not given.")] = None,
    scheduler: Annotated[
        str | None, _option("Address of a Dask scheduler, whose workers make the runs; or slurm.")
    ] = None,
    shard: Annotated[str | None, _option("Make only this part, such as 17/200; the last call has --finish.")] = None,
    finish: Annotated[bool, Parameter(negative=(), help="Complete the set from its parts; make no run.")] = False,
    dry_run: Annotated[
        bool, Parameter(negative=(), help="Make nothing; print what rubgen plan prints, and for slurm a job.")
    ] = False,
    json: Json = False,
) -> int:
    """Make the data set of a recipe, or complete it where it was interrupted.

    One job of an array makes one part with --shard; after the last, --finish completes the set. All write to the same
    directory.
    """
    if dry_run:
        from rubgen.cli.commands.planning import plan_command

        return plan_command(recipe, runs, 0, None, force=False, as_json=json, slurm=scheduler == "slurm")
    from rubgen.cli.commands.generating import Work, generate_command

    work = Work(workers=workers, scheduler=scheduler, shard=shard, finish=finish)
    return generate_command(recipe, out, runs, work, as_json=json)


@app.command
def push(
    directory: Directory,
    url: Annotated[str, _option("Where the set goes, such as s3://bucket/set.")],
    /,
    *,
    json: Json = False,
) -> int:
    """Copy a finished data set to an object store, the manifest last; the same command completes it after a stop."""
    from rubgen.cli.commands.generating import push_command

    return push_command(directory, url, as_json=json)


@app.command
def resense(
    directory: Directory,
    /,
    *,
    sensors: Annotated[str, _option("Sensor set: default, rig, field, field-cheap, or the path of a TOML.")],
    out: Annotated[Path, _option("New or empty directory, or the one of the same command, which is then completed.")],
    workers: Annotated[int | None, _whole_number("Number of processes; the number of cores when not given.")] = None,
    json: Json = False,
) -> int:
    """Make a data set again with other sensors on the same motions; every run is simulated again."""
    from rubgen.cli.commands.generating import resense_command

    return resense_command(directory, sensors, out, workers, as_json=json)


@app.command
def merge(
    *directories: Directory,
    out: Annotated[Path, _option("New or empty directory, or the one of the same command, which is then completed.")],
    json: Json = False,
) -> int:
    """Make one data set of several with other seeds; runs get new names, splits stay, nothing is simulated."""
    from rubgen.cli.commands.generating import merge_command

    return merge_command(directories, out, as_json=json)


@app.command
def init(
    kind: Annotated[Literal["recipe", "machine", "sensors"], _option("What to begin.")],
    file: Annotated[Path | None, _option("File to write; the kind with the ending .toml when not given.")] = None,
    /,
    *,
    origin: Annotated[
        str | None, Parameter(name="--from", help="A recipe, machine or sensor set of rubgen list to begin from.")
    ] = None,
) -> int:
    """Write a file to begin with: a recipe, machine or sensor set of rubgen, with a comment for each key."""
    from rubgen.cli.commands.starting import init_command

    return init_command(kind, origin, file)


@app.command
def plan(
    recipe: RecipeFile = None,
    /,
    *,
    runs: Annotated[int | None, _whole_number("Number of runs, instead of the recipe's.")] = None,
    tries: Annotated[
        int,
        Parameter(
            name="--try", converter=_whole, help="Number of runs to simulate: their classes, and time and sizes here."
        ),
    ] = 0,
    out: Annotated[Path | None, _option("Picture to write: .png, .svg or .pdf.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Say what a recipe draws, which runs can rub, what is refused, minutes and MB, before its data set is made.

    Exit 1 where a run or an extreme is refused.
    """
    from rubgen.cli.commands.planning import plan_command

    return plan_command(recipe, runs, tries, out, force=force, as_json=json)


@app.command(name="list")
def list_offered(*, json: Json = False) -> int:
    """Print the recipes, machines, sensor sets and faults that come with rubgen."""
    from rubgen.cli.commands.starting import list_command

    return list_command(as_json=json)


@app.command
def simulate(
    *,
    machine: MachineName = "zeng2019",
    speed_rpm: Annotated[float | None, _option(TEXTS["speed_rpm"])] = None,
    clearance_m: Annotated[float | None, _option(TEXTS["clearance_m"])] = None,
    free_penetration_m: Annotated[float | None, _option(TEXTS["free_penetration_m"])] = None,
    ovality_m: Annotated[float | None, _option(TEXTS["ovality_m"])] = None,
    disk_support_stiffness_n_per_m: Annotated[float | None, _option(TEXTS["disk_support_stiffness_n_per_m"])] = None,
    casing_support_stiffness_n_per_m: Annotated[
        float | None, _option(TEXTS["casing_support_stiffness_n_per_m"])
    ] = None,
    friction: Annotated[float | None, _option(TEXTS["friction"])] = None,
    lobes: Annotated[float | None, _option(TEXTS["lobes"])] = None,
    unbalance_kg_m: Annotated[float | None, _option(TEXTS["unbalance_kg_m"])] = None,
    casing_thickness_m: Annotated[float | None, _option(TEXTS["casing_thickness_m"])] = None,
    lateral_damping: Annotated[float | None, _option(TEXTS["lateral_damping"])] = None,
    support_anisotropy: Annotated[float | None, _option(TEXTS["support_anisotropy"])] = None,
    gravity_m_per_s2: Annotated[float | None, _option(TEXTS["gravity_m_per_s2"])] = None,
    unbalance_angle_deg: Annotated[float | None, _option(TEXTS["unbalance_angle_deg"])] = None,
    background_m_per_s2: Annotated[
        float | None,
        Parameter(name=("--background-m-per-s2", "--background"), help=TEXTS["background_m_per_s2"]),
    ] = None,
    blade_passing_m_per_s2: Annotated[float | None, _option(TEXTS["blade_passing_m_per_s2"])] = None,
    runout_m: Annotated[float | None, _option(TEXTS["runout_m"])] = None,
    path_gain: Annotated[float | None, _option(TEXTS["path_gain"])] = None,
    fault: Annotated[list[str] | None, Parameter(negative=(), help="A fault: misalignment, bow, ...")] = None,
    profile: Annotated[str, _option(TEXTS["profile"])] = "steady",
    end_speed_rpm: Annotated[float | None, _option(TEXTS["end_speed_rpm"])] = None,
    duration_s: Annotated[float | None, _option(TEXTS["duration_s"])] = None,
    fluctuation_rpm: Annotated[float | None, _option(TEXTS["fluctuation_rpm"])] = None,
    fluctuation_period_s: Annotated[float | None, _option(TEXTS["fluctuation_period_s"])] = None,
    settle_turns: Annotated[int | None, _whole_number(TEXTS["settle_turns"])] = None,
    record_turns: Annotated[int | None, _whole_number(TEXTS["record_turns"])] = None,
    steps_per_turn: Annotated[int, _whole_number(TEXTS["steps_per_turn"])] = 1024,
    sample_rate_hz: Annotated[float, _option(TEXTS["sample_rate_hz"])] = 25600.0,
    sensors: Annotated[str, _option(TEXTS["sensors"])] = "default",
    signal_seconds: Annotated[float, _option(TEXTS["signal_seconds"])] = 1.0,
    seed: Annotated[int, _whole_number(TEXTS["seed"])] = 0,
    lyapunov: Annotated[bool | None, _option(TEXTS["lyapunov"])] = None,
    out: Annotated[Path | None, _option(f"File to write: {ENDINGS}.")] = None,
    force: Force = False,
    replay: Annotated[bool, Parameter(negative=(), help="Then show the run in the viewer.")] = False,
    json: Json = False,
    **fault_keys: Annotated[str, _option("A value of the fault: --parallel-m 5e-5.")],
) -> int:
    """Simulate one run and print its labels; with --out also write its signals."""
    options = dict(locals())
    from rubgen.cli.commands.simulating import simulate_command

    return simulate_command(options, out, replay=replay, force=force, as_json=json)


@app.command
def replay(
    source: Annotated[Path, _option("Directory of a data set, or an MCAP file of rubgen.")],
    run: Annotated[str | None, _option("Name of a run of the data set.")] = None,
    /,
    *,
    where: Annotated[
        str | None, _option("The first run that meets this condition on the columns of runs.parquet.")
    ] = None,
    save: Annotated[Path | None, _option("Write an .rrd file instead of opening the viewer.")] = None,
    gif: Annotated[Path | None, _option("Write an animation of the turns about the hardest touch.")] = None,
    png: Annotated[Path | None, _option("Write a picture of one moment.")] = None,
    foxglove: Annotated[Path | None, _option("Write a layout for Foxglove, .json, with a name at each line.")] = None,
    time: Annotated[float | None, _option("Moment of the picture, s; the hardest touch when not given.")] = None,
    web: Annotated[bool, Parameter(negative=(), help="Open it in the browser, on this machine alone.")] = False,
    full: Annotated[
        bool, Parameter(negative=(), help="Every sample and touch, not only those about the hardest.")
    ] = False,
    force: Force = False,
) -> int:
    """Show a run in Rerun: the machine in 3D, orbit, signals, orders, contact and labels on one time line."""
    from rubgen.cli.commands.replaying import Showing, replay_command

    showing = Showing(save=save, gif=gif, png=png, foxglove=foxglove, time=time, web=web, full=full, force=force)
    return replay_command(source, run, where, showing)


@app.command
def browse(
    directory: Directory,
    /,
    *,
    where: Annotated[
        str | None, _option("Only the good runs that meet this condition on the columns of runs.parquet.")
    ] = None,
    predictions: Annotated[
        Path | None, _option("Answers of a model: .csv or .parquet with the column run_id, shown beside the truth.")
    ] = None,
    web: Annotated[bool, Parameter(negative=(), help="Open it in the browser, on this machine alone.")] = False,
    serve: Annotated[bool, Parameter(negative=(), help="Open no viewer; print the address and serve it.")] = False,
) -> int:
    """Show a whole data set in Rerun: a table of its runs with parameters and labels, each run a click away."""
    from rubgen.cli.commands.browsing import browse_command

    return browse_command(directory, where, predictions, web=web, serve=serve)


@app.command
def figure(
    name: Annotated[
        str,
        _option(
            "Of a machine campbell, critical, unbalance, modes; of a run orbit, contact, waveform, waterfall, bode; "
            "of a data set bifurcation, cascade, exponent, overview."
        ),
    ],
    source: Annotated[Path | None, _option("A machine, a data set's directory, or for one run an MCAP file.")] = None,
    run: Annotated[str | None, _option("Name of a run of the data set.")] = None,
    /,
    *,
    out: Annotated[Path, _option("File to write: .png, .svg or .pdf.")],
    where: Annotated[str | None, _option("The first run that meets this condition.")] = None,
    over: Annotated[str | None, _option("Parameter of a sweep; the first that varies when not given.")] = None,
    channel: Annotated[str | None, _option("Recorded channel to draw.")] = None,
    speeds_rpm: Annotated[
        str | None,
        _option("Range LOW:HIGH of the speed in rev/min; of campbell, critical, unbalance, waterfall and bode."),
    ] = None,
    frequencies_hz: Annotated[str | None, _option("Range LOW:HIGH of the frequency in Hz; of campbell.")] = None,
    modes: Annotated[
        str | None,
        _option("Modes to draw, with commas, as rubgen modes lists them: 7, casing 3, blade 1, ND 2, blade 1 ND 2."),
    ] = None,
    force: Force = False,
) -> int:
    """Draw a figure of a machine, a run or a data set."""
    from rubgen.cli.commands.drawing import figure_command
    from rubgen.report.figures import Choice

    choice = Choice(
        run_id=run, where=where, parameter=over, channel=channel, speeds_rpm=speeds_rpm,
        frequencies_hz=frequencies_hz, modes=modes,
    )  # fmt: skip
    return figure_command(name, source, out, choice, force=force)


@app.command
def report(
    directory: Directory,
    /,
    *,
    out: Annotated[Path | None, _option("File to write; DIR/report.html when not given.")] = None,
    force: Force = False,
) -> int:
    """Write one page that shows a data set: classes, coverage, failures, examples, channels, how to load it."""
    from rubgen.cli.commands.drawing import report_command

    return report_command(directory, out, force=force)


@app.command
def features(
    directory: Place,
    /,
    *,
    out: Annotated[Path, _option("File to write: .parquet.")],
    window: Annotated[str | None, _option("Length such as 0.25s or 16turns; the whole signal when not given.")] = None,
    channels: Annotated[str | None, _option("Names with commas; all that a probe can measure when not given.")] = None,
    set_: Annotated[
        str | None,
        Parameter(name="--set", help="time, order, envelope, orbit, tsfel, with commas; all but tsfel when not given."),
    ] = None,
    workers: Annotated[int | None, _whole_number("Number of processes; the number of cores when not given.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Compute features of the recorded channels, one row a window: from channels and pulses alone, without labels."""
    from rubgen.cli.commands.featuring import features_command

    return features_command(directory, out, window, channels, set_, workers, force=force, as_json=json)


@app.command
def baseline(
    directory: Place,
    /,
    *,
    task: Annotated[
        str | None,
        _option("rub, severity, motion, zones, where, faults, onset, with commas; all possible when not given."),
    ] = None,
    out: Annotated[Path | None, _option("File for the scores: .json.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Score simple models on a data set, by machine or run; exit 1 where one threshold or no model solves a task."""
    from rubgen.cli.commands.scoring import baseline_command

    return baseline_command(directory, task, out, force=force, as_json=json)


@app.command
def export(
    directory: Place,
    /,
    *,
    format_: Annotated[
        str, Parameter(name="--format", help="uff58, mat, hdf5, csv, wav, ts, webdataset, or parquet without answers.")
    ],
    out: Annotated[Path, _option("New or empty folder, or one of the same export, which is then completed.")],
    split: Annotated[str | None, _option("Only this split; all when not given.")] = None,
    channels: Annotated[str | None, _option("Names with commas; all recorded channels when not given.")] = None,
    json: Json = False,
) -> int:
    """Write the runs of a data set in a file format of other programs, with units and sensors."""
    from rubgen.cli.commands.exporting import export_command

    return export_command(directory, out, format_, split, channels, as_json=json)


@app.command
def modes(
    machine: MachineName = "zeng2019",
    /,
    *,
    speed_rpm: Annotated[float, _option("Speed, rev/min; at rest when not given.")] = 0.0,
    json: Json = False,
) -> int:
    """Print the modes of a machine: frequency, family, nodal diameter, whirl, damping; zeng2019 beside the paper."""
    from rubgen.cli.commands.modes import modes_command

    return modes_command(machine, speed_rpm, as_json=json)


@app.command
def info(directory: Place, /, *, json: Json = False) -> int:
    """Count the runs of a data set by status, rub and motion."""
    from rubgen.cli.commands.inspecting import info_command

    return info_command(directory, as_json=json)


@app.command
def label(directory: Place, /, *, json: Json = False) -> int:
    """Make the labels again from what is kept of each run, and compare; exit 1 where one differs.

    The data set is not changed. Labels of orders are left out: they need the signals at every step of the integration.
    """
    from rubgen.cli.commands.inspecting import label_command

    return label_command(directory, as_json=json)


@app.command
def verify(
    directory: Directory,
    /,
    *,
    sample: Annotated[
        int | None, _whole_number("Read only that many shards, drawn anew; of the rest, presence and size.")
    ] = None,
    repair: Annotated[bool, Parameter(negative=(), help="Then do what rubgen repair does.")] = False,
    json: Json = False,
) -> int:
    """Check hashes, checksums, schemas, and labels against signals; exit 1 where something is wrong."""
    from rubgen.cli.commands.inspecting import verify_command

    return verify_command(directory, sample, repair=repair, as_json=json)


@app.command
def repair(directory: Directory, /, *, json: Json = False) -> int:
    """Make lost or damaged files again; exit 1 if something is still wrong.

    Damaged shards are simulated again from the manifest, which needs the versions that made the set. A file gets the
    bytes that the manifest lists or stays as it is; nothing is deleted.
    """
    from rubgen.cli.commands.inspecting import repair_command

    return repair_command(directory, as_json=json)


@app.command
def regenerate(
    directory: Place,
    run: Annotated[str, _option("Name of a run of the data set.")],
    /,
    *,
    out: Annotated[Path | None, _option(f"Also write the run to this file: {ENDINGS}.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Make one run again from the manifest and compare it with the stored one; exit 1 where it differs."""
    from rubgen.cli.commands.regenerating import regenerate_command

    return regenerate_command(directory, run, out, force=force, as_json=json)


@app.command
def doctor(*, json: Json = False) -> int:
    """Print versions, caches, cores and Vulkan of this machine; exit 1 where a package that is needed is missing."""
    from rubgen.cli.commands.doctor import doctor_command

    return doctor_command(as_json=json)


_ZSH_END = """
if [[ "${funcstack[1]}" == "_rubgen" ]]; then
  _cyclopts_rubgen "$@"
else
  (( $+functions[compdef] )) || { autoload -Uz compinit && compinit; }
  compdef _cyclopts_rubgen rubgen
fi
"""
"""Lets the script be read in ~/.zshrc too; as the file _rubgen in $fpath it completes as well."""


@app.command
def completion(
    shell: Annotated[Literal["bash", "zsh", "fish", "powershell"], _option("The shell that is to complete.")], /
) -> int:
    """Print what makes a shell complete commands and options: eval "$(rubgen completion bash)" in ~/.bashrc."""
    sys.stdout.write(app.generate_completion(shell=shell))
    if shell == "zsh":  # what is printed so far works only from a file in $fpath
        sys.stdout.write(_ZSH_END)
    return 0
