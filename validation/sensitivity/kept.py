"""Finished runs on disk, one JSON line each, so that a study that was stopped goes on where it stood."""

from __future__ import annotations

import ast
import hashlib
import json
from pathlib import Path

from pydantic import TypeAdapter

from rubgen.scenario import Scenario
from validation.sensitivity.outcome import Outcome, run

_PACKAGE = Path(__file__).parents[2]
_FOLDERS = ("machine", "scenario", "fem", "reduction", "contact", "solver", "labels")


class KeptRuns:
    """The runs in a file of JSON lines, by the whole scenario and the code that made them.

    A run of other code is not taken: the code is known by a hash of its syntax trees, so comments and layout do not
    count. A line that was cut by a kill is skipped and its run made again.
    """

    def __init__(self, path: Path) -> None:
        self.path, self._code = path, code_digest()
        self._found: dict[str, Outcome] = {}
        if path.exists():
            for line in path.read_text(encoding="utf-8").splitlines():
                self._take(line)

    def outcome(self, scenario: Scenario) -> Outcome:
        """The outcome of `scenario`: from the file, or run now and kept there."""
        key = self._key(scenario)
        if key not in self._found:
            found = run(scenario)
            self._found[key] = found
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with self.path.open("a", encoding="utf-8") as file:
                file.write("\n" + json.dumps({"key": key, "outcome": found.as_dict()}))
        return self._found[key]

    def holds(self, scenario: Scenario) -> bool:
        """Whether the run of `scenario` is finished already."""
        return self._key(scenario) in self._found

    def _key(self, scenario: Scenario) -> str:
        values = TypeAdapter(Scenario).dump_python(scenario, mode="json")
        return hashlib.sha256((self._code + json.dumps(values, sort_keys=True)).encode()).hexdigest()[:24]

    def _take(self, line: str) -> None:
        try:
            row = json.loads(line)
            self._found[row["key"]] = Outcome(**row["outcome"])
        except (ValueError, KeyError, TypeError):
            return


def code_digest() -> str:
    """Hash of the syntax trees of everything between a scenario and its labels."""
    digest = hashlib.sha256()
    for folder in _FOLDERS:
        for source in sorted((_PACKAGE / folder).glob("*.py")):
            digest.update(ast.dump(ast.parse(source.read_text(encoding="utf-8"))).encode())
    return digest.hexdigest()[:16]
