"""Declare the commands that count, check and repair."""

from typing import Annotated

from cyclopts import Parameter

from rubgen.cli.options import Directory, Json, Place, whole_number


def info(directory: Place, /, *, json: Json = False) -> int:
    """Count the runs of a data set by status, rub and motion."""
    from rubgen.cli.commands.inspecting import info_command

    return info_command(directory, as_json=json)


def label(directory: Place, /, *, json: Json = False) -> int:
    """Compute the labels again from the compact record of each run, and compare; exit 1 where a label differs.

    The data set is not changed. Labels of orders are left out: they need the signals at every step of the integration.
    """
    from rubgen.cli.commands.inspecting import label_command

    return label_command(directory, as_json=json)


def verify(
    directory: Directory,
    /,
    *,
    sample: Annotated[
        int | None, whole_number("Read only that many shards, drawn anew; of the rest, presence and size.")
    ] = None,
    repair: Annotated[bool, Parameter(negative=(), help="Then do what rubgen repair does.")] = False,
    json: Json = False,
) -> int:
    """Check hashes, checksums, schemas, and labels against signals; exit 1 where a problem remains."""
    from rubgen.cli.commands.inspecting import verify_command

    return verify_command(directory, sample, repair=repair, as_json=json)


def repair(directory: Directory, /, *, json: Json = False) -> int:
    """Make lost or damaged files again; exit 1 if a problem remains.

    Damaged shards are simulated again from the manifest, which needs the versions that made the set. A file is replaced
    only by the bytes that the manifest lists, but .rrd files may get other bytes. Nothing is deleted.
    """
    from rubgen.cli.commands.inspecting import repair_command

    return repair_command(directory, as_json=json)


def doctor(*, json: Json = False) -> int:
    """Print versions, caches, cores and Vulkan of this computer; exit 1 where a package is missing or unfit."""
    from rubgen.cli.commands.doctor import doctor_command

    return doctor_command(as_json=json)
