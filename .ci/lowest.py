"""The lowest versions that pyproject.toml declares for rubgen's own dependencies, as pins for pip, one a line."""

import re
import sys
import tomllib
from pathlib import Path

project = tomllib.loads(Path(__file__).parents[1].joinpath("pyproject.toml").read_text(encoding="utf-8"))["project"]
for dependency in project["dependencies"]:
    name, bound = re.fullmatch(r"([\w-]+)(?:>=([\w.]+).*)?", dependency).groups()
    sys.stdout.write(f"{name}=={bound}\n" if bound else f"{name}\n")
