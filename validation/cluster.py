"""One set made twice, by two workers and by four Dask workers that are killed, has the same files: `make cluster`.

The set has virtual machines with four runs each, twins, a balance and four splits. Then it is verified, pushed to a
server that speaks S3, opened there, let grow by 100 runs, and merged with a set of another seed. The table goes to
docs/scale.md. All is kept in a folder: the same command after a stop makes the rest.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rubgen
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.keep import kept_runs
from validation.markdown import table, with_tables

PAGE = Path(__file__).parents[1] / "docs" / "scale.md"
RUNS_PER_MACHINE, GROWN, OTHER, KILL_EVERY_S = 4, 25, 8, 5.0
"""Runs of a machine, machines of the growth and of the other set of the merge, seconds between two kills."""
FOLDER = Path("build/cluster")
RECIPE: dict[str, Any] = {
    "name": "cluster",
    "machine": ["zeng2019", "zeng2019-fitted"],
    "machines": {
        "vary": {
            "blade_count": {"choice": [24, 36]},
            "blade_length_m": {"uniform": [0.14, 0.155]},
            "unbalance_kg_m": {"log_uniform": [1e-2, 2e-2]},
        }
    },
    "splits": {
        "train": 0.5,
        "validation": 0.15,
        "test": 0.2,
        "unseen": {"share": 0.15, "machines": {"blade_count": 18}},
    },
    "balance": {"rub": 0.5},
    "twins": {"clearance_m": 1e-3},
    "vary": {"speed_rpm": {"uniform": [9000, 11500]}, "clearance_m": {"uniform": [2.2e-4, 9e-4]}},
    "labels": {"lyapunov": False},
    "output": {"formats": ["parquet"], "signal_seconds": 0.2},
}
CLUSTER = """
import os, signal, sys
from distributed import Client, LocalCluster

if __name__ == "__main__":
    with LocalCluster(n_workers=4, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            print(cluster.scheduler_address, flush=True)
            while sys.stdin.readline():
                pids = sorted(client.run(os.getpid, on_error='ignore').values())
                if pids:
                    os.kill(pids[0], signal.SIGKILL)
                print(len(pids), flush=True)
"""
SERVER = """
import logging, sys
from moto.moto_server.threaded_moto_server import ThreadedMotoServer
logging.getLogger("werkzeug").setLevel("ERROR")  # no line for each request
server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
server.start()
print(server.get_host_and_port()[1], flush=True)
sys.stdin.read()
"""


def recipe(machines: int, seed: int = 15) -> dict[str, Any]:
    """The recipe with that many machines."""
    return {
        **RECIPE,
        "seed": seed,
        "machines": {**RECIPE["machines"], "count": machines, "runs_per_machine": RUNS_PER_MACHINE},
    }


def digests(directory: Path) -> dict[str, str]:
    """The sha256 of every file of a set, by its path."""
    files = sorted(path for path in directory.rglob("*") if path.is_file())
    return {path.relative_to(directory).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


@contextmanager
def process(program: str, folder: Path) -> Iterator[subprocess.Popen[str]]:
    """A process of Python that prints one line when it is ready, and ends with its standard input."""
    file = folder / "program.py"
    file.write_text(program, encoding="utf-8")
    pipe = subprocess.PIPE
    with subprocess.Popen([sys.executable, str(file)], stdin=pipe, stdout=pipe, text=True) as started:
        yield started
        if started.stdin:
            started.stdin.close()


def said(started: subprocess.Popen[str]) -> str:
    """The next line of the process."""
    return started.stdout.readline().strip() if started.stdout else ""


def say(text: str) -> None:
    """Print the time and a step that begins."""
    print(f"{time.strftime('%H:%M:%S')} {text}", file=sys.stderr, flush=True)


def finished(out: Path) -> int:
    """The number of finished runs of a set that is being made."""
    layout = Layout(out)
    kept = sum(len(kept_runs(layout, path.name)) for path in (out / ".staging" / "kept").glob("*"))
    return kept + sum(
        int(json.loads(path.read_text())["runs"]) for path in (out / ".staging" / "closed").glob("*.json")
    )


def killed(machines: int, out: Path, folder: Path) -> int:
    """Make the set with four Dask workers, of which one is killed every few seconds. The number of kills so far."""
    done, log = threading.Event(), folder / "kills.txt"
    with process(CLUSTER, folder) as started:
        address = said(started)

        def kill() -> None:
            seen = 0
            while not done.wait(KILL_EVERY_S):
                try:
                    runs = finished(out)
                except FileNotFoundError:  # a shard was closed meanwhile
                    continue
                if started.stdin and runs > seen:  # the set went on since the last kill
                    seen = runs
                    started.stdin.write("kill\n")
                    started.stdin.flush()
                    with log.open("a", encoding="utf-8") as stream:
                        stream.write("kill\n" * bool(int(said(started))))

        killer = threading.Thread(target=kill)
        killer.start()
        try:
            rubgen.generate(recipe(machines), out, scheduler=address, progress=True)
        finally:
            done.set()
            killer.join()
    return log.read_text(encoding="utf-8").count("kill") if log.exists() else 0


def opened_at_s3(directory: Path, folder: Path) -> bool:
    """Push a set to a server that speaks S3. Whether what is read there is what is in the directory."""
    with process(SERVER, folder) as started:
        names = {
            "ENDPOINT_URL": f"http://127.0.0.1:{said(started)}",
            "ACCESS_KEY_ID": "key",
            "SECRET_ACCESS_KEY": "key",
        }
        os.environ.update({f"AWS_{name}": value for name, value in names.items()} | {"AWS_DEFAULT_REGION": "us-east-1"})
        import fsspec

        fsspec.filesystem("s3").mkdir("bucket")
        rubgen.push(directory, "s3://bucket/set")
        there, here = rubgen.open("s3://bucket/set"), rubgen.open(directory)
        run_id = here.ok.index[-1]
        signals = there.signals(run_id)
        same = all((signals[name] == values).all() for name, values in here.signals(run_id).items())
        return bool(there.runs.equals(here.runs)) and same


def study(machines: int, folder: Path) -> str:
    """Do all in the folder and compose the table."""
    quiet, rough, grown, other, merged = (folder / name for name in ("quiet", "rough", "grown", "other", "merged"))
    rows: list[list[str]] = []

    def found(what: str, text: object) -> None:
        say(f"{what}: {text}")
        rows.append([what, str(text)])

    say("make the set with two workers")
    made = rubgen.generate(recipe(machines), quiet, workers=2, progress=True)
    data = rubgen.open(quiet)
    found("runs", f"{made.runs}: {', '.join(f'{count} {each}' for each, count in made.status.items())}")
    found("splits", ", ".join(f"{each} {count}" for each, count in data.runs["split"].value_counts().items()))
    found("machines", data.runs["machine_id"].nunique())
    good = data.ok
    found("twins; runs that rub", f"{data.runs['twin_of'].notna().sum()}; {good['rub'].sum()}")
    say("make it with four Dask workers that are killed")
    found("workers killed", killed(machines, rough, folder))
    before = digests(quiet)
    found("files with other bytes", f"{_different(before, digests(rough))} of {len(before)}")
    found("problems that verify finds", len(rubgen.verify(rough)))
    found("equal when read from S3", "yes" if opened_at_s3(rough, folder) else "no")
    say("let it grow")
    if not grown.exists():
        shutil.copytree(quiet, folder / "copied", dirs_exist_ok=True)
        (folder / "copied").rename(grown)
    rubgen.generate(recipe(machines + GROWN), grown, workers=2, progress=True)
    after = rubgen.open(grown)
    same = after.runs.iloc[: made.runs].equals(data.runs)
    found(f"grown to {len(after.runs)} runs", f"old rows {'equal' if same else 'changed'}")
    found("problems that verify finds then", len(rubgen.verify(grown)))
    say("merge it")
    rubgen.generate(recipe(OTHER, seed=16), other, workers=2, progress=True)
    second = rubgen.open(other).runs
    rubgen.merge([grown, other], merged, progress=True)
    both = rubgen.open(merged).runs
    parts = [each.reset_index(drop=True).drop(columns="twin_of") for each in (after.runs, second)]
    halves = [both.iloc[: len(after.runs)], both.iloc[len(after.runs) :]]
    halves = [half.reset_index(drop=True)[list(part.columns)] for half, part in zip(halves, parts, strict=True)]
    same = all(half.equals(part) for half, part in zip(halves, parts, strict=True))
    found(f"merged with a set of {len(second)}", f"{len(both)} runs, rows {'equal' if same else 'changed'}")
    found("problems that verify finds in it", len(rubgen.verify(merged)))
    return table(["what", "found"], rows)


def _different(one: dict[str, str], other: dict[str, str]) -> int:
    return sum(one.get(name) != other.get(name) for name in one.keys() | other.keys())


def main() -> None:
    """Write the table to the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.cluster")
    parser.add_argument("--machines", type=int, default=200, help=f"each has {RUNS_PER_MACHINE} runs")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where the sets are; it is kept")
    options = parser.parse_args()
    folder = options.folder / str(options.machines)
    folder.mkdir(parents=True, exist_ok=True)
    text = study(options.machines, folder)
    print(text)
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(with_tables(page, {"study": text}), encoding="utf-8")


if __name__ == "__main__":
    main()
