"""The commands `rubgen list` and `rubgen init`."""

from pathlib import Path

from rubgen.brief import in_shell
from rubgen.cli.printing import check_new_file, print_json, say
from rubgen.errors import UserError
from rubgen.planning.begin import USES, begin
from rubgen.planning.offered import DEFAULTS, offered, offered_faults

TITLES = {"recipe": "recipes", "machine": "machines", "sensors": "sensor sets"}


def list_command(*, as_json: bool) -> int:
    """Print the recipes, machines, sensor sets and faults that come with rubgen, each with one sentence.

    With `as_json` they are printed as JSON. Returns the exit code 0.
    """
    found = {TITLES[kind]: offered(kind) for kind in TITLES} | {"faults": offered_faults()}
    if as_json:
        print_json({title.replace(" ", "_"): names for title, names in found.items()})
        return 0
    width = max(len(name) for names in found.values() for name in names)
    for title, names in found.items():
        say(title)
        for name, about in names.items():
            say(f"  {name:<{width}}  {about}")
    return 0


def init_command(kind: str, origin: str | None, path: Path | None) -> int:
    """Write a commented file of the given kind and print how to use it. Returns the exit code 0.

    - kind: recipe, machine or sensors.
    - origin: name of the file of rubgen to begin from; None is the default of the kind.
    - path: file to write; None is the kind with the ending .toml, in the current directory.

    The schema by which editors explain the keys is written beside it, if it is not there yet. Raises UserError where
    the file exists or cannot be written, its name does not end in .toml, it would lie in a data set, or `origin` is
    unknown.
    """
    path = path or Path(f"{kind}.toml")
    if path.exists():
        raise UserError(f"FILE {path}: exists already, and rubgen init overwrites nothing; give another name")
    check_new_file("FILE", path, (".toml",))
    written = begin(kind, origin or DEFAULTS[kind], path)
    also = f", and {written[1].name} beside it, by which editors explain its keys" if len(written) > 1 else ""
    say(f"written {path}{also}")
    say(USES[kind].format(file=path, word=in_shell(path)))
    return 0
