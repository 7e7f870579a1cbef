"""Write one run as a Rerun recording (.rrd): a view made from the run, opened with `rerun FILE`."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from rubgen.scenario.scenario import scenario_dict

if TYPE_CHECKING:
    from rerun import RecordingStream
    from rerun.blueprint import Blueprint

    from rubgen.pipeline import Run
    from rubgen.scenario import Scenario
    from rubgen.viz.replay import Replay

APPLICATION = "rubgen"
ENTITIES = ("/preview/", "/detail/", "/labels/motion", "/labels/text", "/__properties/labels")


def write_rrd(run: Run, path: Path) -> None:
    """Write a run in memory as `write_replay` does. Raises ValueError for a run without a recording."""
    from rubgen.viz.replay import replay_of

    write_replay(replay_of(run), path)


def write_replay(replay: Replay, path: Path, *, full: bool = False, named: str = "") -> None:
    """Write `replay` to a Rerun recording at `path`, complete or not at all, with a default arrangement of views.

    It has the machine in 3D with its contact points; every channel as minimum and maximum (`/preview/<quantity>`) and
    at full rate over 20 turns around the hardest touch (`/detail/<quantity>`; the middle without contact); touches,
    orbit, order spectra, motion classes, labels and scenario as text and as properties. It takes about a megabyte for
    any length; with `full` every sample and every touch are written. The id of the recording is `named`, or
    `recording_id` if `named` is empty. Times are ns from the first sample. Two recordings of the same replay differ in
    their bytes, not in their content. A file at `path` is replaced. Raises OSError where the file cannot be written.
    """
    from rerun_bindings import flush_and_cleanup_orphaned_recordings

    content = _recorded(replay, full=full, named=named)
    # A stream that nobody refers to keeps its threads and its data, some 5 MB a run, until it is asked to go.
    flush_and_cleanup_orphaned_recordings()
    part = path.with_name(f"{path.name}.part")
    try:
        part.write_bytes(content)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _recorded(replay: Replay, *, full: bool, named: str) -> bytes:
    """Return the content of the .rrd file."""
    import rerun as rr  # here, for importing it takes 0.6 s

    from rubgen.viz.entities.events import send_tip_timing, send_touches
    from rubgen.viz.entities.labels import send_labels
    from rubgen.viz.entities.machine import send_machine
    from rubgen.viz.entities.orbit import send_orbit
    from rubgen.viz.entities.orders import send_orders
    from rubgen.viz.entities.signals import send_signals
    from rubgen.viz.views import arrangement

    name = named or recording_id(replay.scenario)
    stream = rr.RecordingStream(APPLICATION, recording_id=name, send_properties=False)
    # Rerun's own file writer is a thread that only logs a full disk, and that its stream may then wait for without end.
    memory = stream.memory_recording()
    _send_blueprint(stream, arrangement(replay, full=full))
    stream.send_recording_name(replay.scenario.run_id)
    send_signals(stream, replay, full=full)
    send_touches(stream, replay, full=full)
    send_machine(stream, replay)
    send_orbit(stream, replay)
    send_tip_timing(stream, replay, full=full)
    send_orders(stream, replay)
    send_labels(stream, replay)
    content = memory.drain_as_bytes()
    stream.disconnect()
    return content


def _send_blueprint(stream: RecordingStream, blueprint: Blueprint) -> None:
    """Make `blueprint` the recording's default.

    The same steps as Rerun's own `send_blueprint`, but its stream is disconnected. Rerun 0.41 does not do that, and
    keeps two threads and 3 MB a blueprint for ever.
    """
    import rerun_bindings as bindings
    from rerun import RecordingStream

    own = RecordingStream._from_native(
        bindings.new_blueprint(
            application_id=APPLICATION, make_default=False, make_thread_default=False, default_enabled=True
        )
    )
    own.set_time("blueprint", sequence=0)
    blueprint._log_to_stream(own)
    bindings.send_blueprint(own.memory_recording().storage, False, True, recording=stream.to_native())
    own.disconnect()


def check_rrd(path: Path, run_id: str | None = None) -> list[str]:
    """Check the recording at `path` with `rerun rrd verify`, then as `content_problems` does. Returns its problems.

    `run_id` is the name of the run that the recording must contain; None does not check it. A missing file is a problem
    in the list, not an error.
    """
    if not path.is_file():
        return ["there is no such file"]
    command = [sys.executable, "-m", "rerun", "rrd", "verify", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - our own interpreter
    if done.returncode != 0:
        lines = (done.stderr.strip() or done.stdout.strip() or "no reason given").splitlines()
        return [f"rerun rrd verify: {lines[-1]}"]
    return content_problems(path, run_id)


def content_problems(path: Path, run_id: str | None = None) -> list[str]:
    """Return the problems of the recording at `path`: missing content of `write_rrd`, or another run than `run_id`.

    `run_id` None does not check the run. A file that cannot be decoded has one problem. The file is decoded in this
    process: use it only for files whose bytes are proven to be as written.
    """
    from rerun.chunk import RrdReader

    try:
        reader = RrdReader(path)
        entities = {chunk.entity_path for chunk in reader.stream().to_chunks()}
        runs = {entry.recording_id.rpartition("-")[0] for entry in reader.recordings()}
    except RuntimeError as error:
        return [str(error)]
    if run_id is not None and runs != {run_id}:
        return [f"holds {', '.join(sorted(runs)) or 'no run'}"]
    return [f"no {name}" for name in ENTITIES if not any(entity.startswith(name) for entity in entities)]


def id_in(path: Path) -> str | None:
    """Return the id of the recording in a file; None if the file does not exist or is not readable, or has several."""
    from rerun.chunk import RrdReader

    try:
        found = [entry.recording_id for entry in RrdReader(path).recordings()] if path.is_file() else []
    except RuntimeError:
        return None
    return found[0] if len(found) == 1 else None


def recording_id(scenario: Scenario) -> str:
    """Return the id of a run's recording: the name of the run and a hash of its scenario.

    The same run always has the same id, and no two runs have the same.
    """
    digest = hashlib.sha256(json.dumps(scenario_dict(scenario), sort_keys=True).encode()).hexdigest()
    return f"{scenario.run_id}-{digest[:12]}"
