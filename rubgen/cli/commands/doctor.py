"""The command `rubgen doctor`: whether this computer can run rubgen."""

import os
import platform
import shutil
import sys
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path

from packaging.requirements import Requirement

from rubgen import __version__
from rubgen.cache_root import FOLDERS, problem_of, wanted_root
from rubgen.cli.printing import print_json, print_pairs, say
from rubgen.dataset.making.workers import usable_cores

_VULKAN_DRIVERS = ("/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d")
_SOFTWARE_DRIVER = "lvp_icd"
"""Mesa's lavapipe, which draws without a graphics card."""


def doctor_command(*, as_json: bool) -> int:
    """Print versions, caches, cores, Vulkan and screen of this computer.

    With `as_json` they are printed as JSON. Returns the exit code 1 where a package is missing or outside of the
    versions that rubgen declares, else 0.
    """
    root = wanted_root()
    problem = problem_of(root)
    needed = _needed()
    packages = {requirement.name: _version(requirement) for requirement in needed}
    found: dict[str, object] = {
        "rubgen": __version__,
        "python": f"{platform.python_version()} ({sys.executable})",
        "platform": platform.platform(),
        "packages": packages,
        "cache": str(root),
        "cache_writable": not problem,
        "cache_problem": problem or None,
        **{f"cache_{name}": _folder(root / name) for name in FOLDERS},
        "cores": os.cpu_count(),
        "usable_cores": usable_cores(),
        "vulkan": _vulkan(),
        "screen": _has_screen(),
    }
    problems = [text for requirement in needed if (text := _problem(requirement, packages[requirement.name]))]
    (print_json if as_json else print_pairs)(found | {"ok": not problems, "problems": problems})
    if problem and not as_json:
        say(f"the cache cannot be used ({problem}): a temporary folder takes its place; RUBGEN_CACHE_DIR names another")
    return 1 if problems else 0


def _needed() -> list[Requirement]:
    """Return the declared requirements of rubgen, without extras."""
    declared = map(Requirement, requires("rubgen") or [])
    return [each for each in declared if each.marker is None or each.marker.evaluate({"extra": ""})]


def _version(requirement: Requirement) -> str | None:
    """Return the installed version; None where there is none."""
    try:
        return version(requirement.name)
    except PackageNotFoundError:
        return None


def _problem(requirement: Requirement, found: str | None) -> str:
    """Return the problem of a package; empty without one."""
    name, allowed = requirement.name, requirement.specifier
    if found is None:
        return f"{name}: not installed; install rubgen again"
    if allowed.contains(found, prereleases=True):
        return ""
    return f"{name}: version {found} is installed, rubgen needs {allowed}; install rubgen again"


def _folder(folder: Path) -> dict[str, object]:
    files = []
    with suppress(OSError):
        files = [each for each in folder.rglob("*") if each.is_file()]
    size = 0
    for each in files:
        with suppress(OSError):
            size += each.stat().st_size
    return {"exists": folder.is_dir(), "files": len(files), "megabytes": round(size / 1e6, 1)}


def _vulkan() -> str:
    """Return how pictures can be drawn without a screen: hardware, software or none, from the files of drivers."""
    named = os.environ.get("VK_DRIVER_FILES") or os.environ.get("VK_ICD_FILENAMES")
    files = [Path(each) for each in named.split(os.pathsep)] if named else []
    files = files or [each for folder in _VULKAN_DRIVERS for each in Path(folder).glob("*.json")]
    software = any(each.name.startswith(_SOFTWARE_DRIVER) for each in files)
    card = any(Path("/dev/dri").glob("renderD*")) or shutil.which("nvidia-smi") is not None
    return "hardware" if files and card else "software" if software else "none"


def _has_screen() -> bool:
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
