"""Declare the commands for one run or one machine."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rubgen.cli.option_texts import TEXTS
from rubgen.cli.options import Force, Json, MachineName, Place, here, option, whole_number
from rubgen.format_names import ENDINGS


def simulate(
    *,
    machine: MachineName = "zeng2019",
    speed_rpm: Annotated[float | None, option(TEXTS["speed_rpm"])] = None,
    clearance_m: Annotated[float | None, option(TEXTS["clearance_m"])] = None,
    free_penetration_m: Annotated[float | None, option(TEXTS["free_penetration_m"])] = None,
    ovality_m: Annotated[float | None, option(TEXTS["ovality_m"])] = None,
    disk_support_stiffness_n_per_m: Annotated[float | None, option(TEXTS["disk_support_stiffness_n_per_m"])] = None,
    casing_support_stiffness_n_per_m: Annotated[float | None, option(TEXTS["casing_support_stiffness_n_per_m"])] = None,
    friction: Annotated[float | None, option(TEXTS["friction"])] = None,
    lobes: Annotated[float | None, option(TEXTS["lobes"])] = None,
    unbalance_kg_m: Annotated[float | None, option(TEXTS["unbalance_kg_m"])] = None,
    casing_thickness_m: Annotated[float | None, option(TEXTS["casing_thickness_m"])] = None,
    lateral_damping: Annotated[float | None, option(TEXTS["lateral_damping"])] = None,
    support_anisotropy: Annotated[float | None, option(TEXTS["support_anisotropy"])] = None,
    gravity_m_per_s2: Annotated[float | None, option(TEXTS["gravity_m_per_s2"])] = None,
    unbalance_angle_deg: Annotated[float | None, option(TEXTS["unbalance_angle_deg"])] = None,
    background_m_per_s2: Annotated[
        float | None,
        Parameter(name=("--background-m-per-s2", "--background"), help=TEXTS["background_m_per_s2"]),
    ] = None,
    blade_passing_m_per_s2: Annotated[float | None, option(TEXTS["blade_passing_m_per_s2"])] = None,
    runout_m: Annotated[float | None, option(TEXTS["runout_m"])] = None,
    path_gain: Annotated[float | None, option(TEXTS["path_gain"])] = None,
    fault: Annotated[list[str] | None, Parameter(negative=(), help="A fault: misalignment, bow, ...")] = None,
    profile: Annotated[str, option(TEXTS["profile"])] = "steady",
    end_speed_rpm: Annotated[float | None, option(TEXTS["end_speed_rpm"])] = None,
    duration_s: Annotated[float | None, option(TEXTS["duration_s"])] = None,
    fluctuation_rpm: Annotated[float | None, option(TEXTS["fluctuation_rpm"])] = None,
    fluctuation_period_s: Annotated[float | None, option(TEXTS["fluctuation_period_s"])] = None,
    settle_turns: Annotated[int | None, whole_number(TEXTS["settle_turns"])] = None,
    record_turns: Annotated[int | None, whole_number(TEXTS["record_turns"])] = None,
    steps_per_turn: Annotated[int, whole_number(TEXTS["steps_per_turn"])] = 1024,
    sample_rate_hz: Annotated[float, option(TEXTS["sample_rate_hz"])] = 25600.0,
    sensors: Annotated[str, option(TEXTS["sensors"])] = "default",
    signal_seconds: Annotated[float, option(TEXTS["signal_seconds"])] = 1.0,
    seed: Annotated[int, whole_number(TEXTS["seed"])] = 0,
    lyapunov: Annotated[bool | None, option(TEXTS["lyapunov"])] = None,
    out: Annotated[Path | None, here(f"File to write: {ENDINGS}.")] = None,
    force: Force = False,
    replay: Annotated[bool, Parameter(negative=(), help="Then show the run in the viewer.")] = False,
    json: Json = False,
    **fault_keys: Annotated[str, option("A value of the fault: --parallel-m 5e-5.")],
) -> int:
    """Simulate one run and print its labels; with --out also write its signals. Exit 1 where the run fails."""
    options = dict(locals())
    from rubgen.cli.commands.simulating import simulate_command

    return simulate_command(options, out, replay=replay, force=force, as_json=json)


def replay(
    source: Annotated[Path, here("Directory of a data set, or an MCAP file of rubgen.")],
    run: Annotated[str | None, option("Name of a run of the data set.")] = None,
    /,
    *,
    where: Annotated[
        str | None, option("The first run that meets this condition on the columns of runs.parquet.")
    ] = None,
    save: Annotated[Path | None, here("Write an .rrd file instead of opening the viewer.")] = None,
    gif: Annotated[Path | None, here("Write an animation of the turns about the hardest touch.")] = None,
    png: Annotated[Path | None, here("Write a picture of one moment.")] = None,
    foxglove: Annotated[Path | None, here("Write a layout for Foxglove, .json, with a name at each line.")] = None,
    time: Annotated[float | None, option("Moment of the picture, s; the hardest touch when not given.")] = None,
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


def regenerate(
    directory: Place,
    run: Annotated[str, option("Name of a run of the data set.")],
    /,
    *,
    out: Annotated[Path | None, here(f"Also write the run to this file: {ENDINGS}.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Simulate one run again and compare it with the stored one; exit 1 where versions do not explain a difference."""
    from rubgen.cli.commands.regenerating import regenerate_command

    return regenerate_command(directory, run, out, force=force, as_json=json)


def modes(
    machine: MachineName = "zeng2019",
    /,
    *,
    speed_rpm: Annotated[float, option("Speed, rev/min; at rest when not given.")] = 0.0,
    json: Json = False,
) -> int:
    """Print the modes of a machine: frequency, family, nodal diameter, whirl, damping; zeng2019 beside the paper."""
    from rubgen.cli.commands.modes import modes_command

    return modes_command(machine, speed_rpm, as_json=json)
