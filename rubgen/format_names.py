"""The names of the file formats. `rubgen.formats.<name>` is the format of that name."""

from typing import Literal, get_args

FormatName = Literal["parquet", "mcap", "rrd"]
FORMAT_NAMES: tuple[FormatName, ...] = get_args(FormatName)
_SORTED = sorted(f".{name}" for name in FORMAT_NAMES)
ENDINGS = f"{', '.join(_SORTED[:-1])} or {_SORTED[-1]}"
"""The endings of files in a sentence."""
