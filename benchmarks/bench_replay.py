"""Recordings for Rerun of ten seconds of machine time: size, time to open, and the viewer's memory.

A light rub of the preset at 10,000 rev/min, eleven channels at 25.6 kHz: at preview rate as `rubgen replay --save`
writes it, and with `--full`. They are opened in the viewer without a screen, which draws with a software Vulkan driver
(Debian's `mesa-vulkan-drivers`); where there is none the rows say so. Opening lasts from the call until all views are
there and nothing loads any more; what is on the screen afterwards comes at the driver's own speed.
"""

from __future__ import annotations

import os
import socket
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from benchmarks.bench_memory import _family, _proportional_kilobytes
from rubgen import make_scenario, simulate
from rubgen.viz.replay import replay_of
from rubgen.viz.rerun import write_replay

SECONDS, RECORD_TURNS = 10.0, 1800
DRIVERS = Path("/usr/share/vulkan/icd.d")
PATIENCE = 60.0
SETTLING = 2.0


def measure() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder:
        preview, full = Path(folder) / "preview.rrd", Path(folder) / "full.rrd"
        replay = replay_of(simulate(_scenario()))
        begun = time.process_time()
        write_replay(replay, preview)
        written = time.process_time() - begun
        write_replay(replay, full, full=True)
        rows: list[dict[str, object]] = [
            _row(".rrd of 10 s at preview rate", _megabytes(preview), "MB", "<= 2"),
            _row(".rrd of 10 s, --full", _megabytes(full), "MB", "recorded"),
            _row("writing the .rrd at preview rate, CPU", written, "s", "recorded"),
        ]
        return rows + _viewed(preview, full)


def _row(name: str, value: float, unit: str, target: str) -> dict[str, object]:
    return {"name": name, "value": value, "unit": unit, "target": target}


def _scenario() -> Any:
    scenario = make_scenario("zeng2019", speed_rpm=10000.0, disk_support_stiffness_n_per_m=2e8)
    return replace(
        scenario,
        signal_seconds=SECONDS,
        operation=replace(scenario.operation, settle_turns=100, record_turns=RECORD_TURNS),
        labelling=replace(scenario.labelling, lyapunov=False),
    )


def _megabytes(path: Path) -> float:
    return path.stat().st_size / 1e6


def _viewed(preview: Path, full: Path) -> list[dict[str, object]]:
    name = "opening the .rrd in the viewer"
    if not any(DRIVERS.glob("lvp_icd*.json")):
        note = "needs a software Vulkan driver: mesa-vulkan-drivers"
        return [{"name": name, "value": None, "unit": "s", "target": "< 3", "note": note}]
    small, large = _seen(preview), _seen(full)
    return [
        _row(name, small.seconds, "s", "< 3"),
        _row(f"{name}: CPU of the viewer", small.spent, "s", "recorded"),
        _row("opening the .rrd with --full", large.seconds, "s", "recorded"),
        _row("start of the viewer before that", small.started, "s", "recorded"),
        _row("viewer's memory, nothing open", small.empty, "MB", "recorded"),
        _row("viewer's memory, preview rate", small.filled, "MB", "recorded"),
        _row("viewer's memory, --full", large.filled, "MB", "recorded"),
    ]


@dataclass(frozen=True)
class Seen:
    """Times in s of start and opening, CPU time of opening, and memory in MB before and after."""

    started: float
    seconds: float
    spent: float
    empty: float
    filled: float


def _seen(path: Path) -> Seen:
    """A file in a viewer of its own."""
    begun = time.perf_counter()
    viewer = _start()
    try:
        started, empty = time.perf_counter() - begun, _viewer_megabytes()
        seconds, spent = _open(viewer, path)
        time.sleep(SETTLING)
        return Seen(started, seconds, spent, empty, _viewer_megabytes())
    finally:
        viewer.quit()


def _start() -> Any:
    from rerun.experimental import ViewerClient

    os.environ.setdefault("RUST_LOG", "off")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    return ViewerClient.spawn(headless=True, port=port, executable_path=str(Path(sys.executable).with_name("rerun")))


def _open(viewer: Any, path: Path) -> tuple[float, float]:
    """Wall time until a file is open and nothing loads, and the viewer's CPU time in it, s."""
    begun, spent = time.perf_counter(), _viewer_cpu()
    viewer.open(str(path))
    while time.perf_counter() - begun < PATIENCE:
        state = viewer.get_state()
        if state.views and not state.loading:
            return time.perf_counter() - begun, _viewer_cpu() - spent
        time.sleep(0.02)
    raise RuntimeError(f"{path.name} is not open after {PATIENCE:g} s")


def _viewer_pids() -> list[int]:
    return [pid for pid in _family(os.getpid())[1:] if "rerun" in Path(f"/proc/{pid}/cmdline").read_text()]


def _viewer_megabytes() -> float:
    return sum(_proportional_kilobytes(pid) for pid in _viewer_pids()) / 1024


def _viewer_cpu() -> float:
    """CPU time of the viewer so far, s: fields 14 and 15 of /proc/PID/stat, in ticks."""
    ticks = 0
    for pid in _viewer_pids():
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")
