"""What can be read of a damaged MCAP file, and what is lost."""

from pathlib import Path

from rubgen.errors import UserError
from rubgen.io.mcap.content import read_content
from rubgen.io.mcap.read import McapRun, read_mcap, run_of
from rubgen.io.mcap.records import DamageError

MOST_NAMED = 3


def salvage_mcap(path: Path) -> tuple[McapRun, list[str]]:
    """The run in the file at `path`, and its losses, one sentence each: none for a good file.

    Chunks that fail their CRC are left out, and everything after the place where the records can no longer be followed.
    Lost samples are NaN. Raises UserError where scenario or labels are lost, where the rest contradicts itself, or it
    is no file of rubgen.
    """
    try:
        return read_mcap(path), []
    except UserError as error:
        whole = UserError(str(error))  # without the frames that still hold what was read
    lost: list[str] = []
    try:
        content = read_content(path, lost)
        run = run_of(content, gaps=bool(lost))
    except (DamageError, UserError, OSError):
        raise whole from None
    return run, _shortened(lost) or ["nothing that is shown"]


def _shortened(lost: list[str]) -> list[str]:
    more = len(lost) - MOST_NAMED
    return lost[:MOST_NAMED] + ([f"and {more} more pieces"] if more > 0 else [])
