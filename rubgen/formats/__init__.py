"""The file formats of runs, one file a format.

A new format is a module here with a `FORMAT`, its name in `rubgen.format_names`, and a test. Making, checking,
repairing and describing a data set, `Run.save` and the commands follow from these.
"""

from rubgen.formats.format import Format, format_of, run_formats

__all__ = ["Format", "format_of", "run_formats"]
