"""Declare the commands that make a data set."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rubgen.cli.options import Directory, Json, RecipeFile, here, option, place, whole_number


def generate(
    recipe: RecipeFile = None,
    /,
    *,
    out: Annotated[
        Path, place("New or empty directory, or one of the same recipe, which is then completed; or a URL for one.")
    ],
    runs: Annotated[
        int | None, whole_number("Number of runs, instead of the recipe's; a larger one lets a finished set grow.")
    ] = None,
    workers: Annotated[int | None, whole_number("Number of processes; the number of cores when not given.")] = None,
    scheduler: Annotated[
        str | None, option("Address of a Dask scheduler, whose workers make the runs; or slurm.")
    ] = None,
    shard: Annotated[str | None, option("Make only this part, such as 17/200; the last call has --finish.")] = None,
    finish: Annotated[bool, Parameter(negative=(), help="Complete the set from its parts; make no run.")] = False,
    dry_run: Annotated[
        bool, Parameter(negative=(), help="Make nothing; print what rubgen plan prints, and for slurm a job.")
    ] = False,
    json: Json = False,
) -> int:
    """Make the data set of a recipe, or complete it after an interruption.

    Exit 1 where no run of the set is ok. For an array of jobs, each job makes one part with --shard, in the same
    directory. After the last job, --finish completes the set.
    """
    if dry_run:
        from rubgen.cli.commands.planning import plan_command

        return plan_command(recipe, runs, 0, None, force=False, as_json=json, slurm=scheduler == "slurm")
    from rubgen.cli.commands.generating import Work, generate_command

    work = Work(workers=workers, scheduler=scheduler, shard=shard, finish=finish)
    return generate_command(recipe, out, runs, work, as_json=json)


def resense(
    directory: Directory,
    /,
    *,
    sensors: Annotated[str, option("Sensor set: default, rig, field, field-cheap, or the path of a TOML.")],
    out: Annotated[Path, here("New or empty directory, or the one of the same command, which is then completed.")],
    workers: Annotated[int | None, whole_number("Number of processes; the number of cores when not given.")] = None,
    json: Json = False,
) -> int:
    """Make a data set again with other sensors on the same motions; every run is simulated again.

    Exit 1 where no run of the set is ok.
    """
    from rubgen.cli.commands.generating import resense_command

    return resense_command(directory, sensors, out, workers, as_json=json)


def merge(
    *directories: Directory,
    out: Annotated[Path, here("New or empty directory, or the one of the same command, which is then completed.")],
    json: Json = False,
) -> int:
    """Make one data set of several that have different seeds; runs get new names, splits stay.

    No run is simulated, except for .rrd files of sets without MCAP files. Exit 1 where no run of the set is ok.
    """
    from rubgen.cli.commands.generating import merge_command

    return merge_command(directories, out, as_json=json)


def push(
    directory: Directory,
    url: Annotated[str, option("Where the set goes, such as s3://bucket/set.")],
    /,
    *,
    json: Json = False,
) -> int:
    """Copy a finished data set to an object store, the manifest last; the same command continues after a stop."""
    from rubgen.cli.commands.generating import push_command

    return push_command(directory, url, as_json=json)
