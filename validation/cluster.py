"""One set made twice, by two workers and by four Dask workers that are killed, has the same files: `make cluster`.

The set has virtual machines with four runs each, twins, a balance and four splits. Then it is verified, pushed to a
server that speaks S3, opened there, and let grow by two machines. The table goes to docs/scale.md.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import rubgen
from validation.markdown import table

PAGE = Path(__file__).parents[1] / "docs" / "scale.md"
MARKS = ("<!-- study -->\n", "\n<!-- end -->")
RUNS_PER_MACHINE, GROWN, KILL_EVERY_S = 4, 2, 5.0
RECIPE: dict[str, Any] = {
    "name": "cluster",
    "seed": 15,
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
    "vary": {"speed_rpm": {"uniform": [9000, 11500]}, "clearance_m": {"uniform": [2.2e-4, 3.5e-4]}},
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
                pids = sorted(client.run(os.getpid).values())
                if pids:
                    os.kill(pids[0], signal.SIGKILL)
                print(len(pids), flush=True)
"""
SERVER = """
import sys
from moto.moto_server.threaded_moto_server import ThreadedMotoServer
server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
server.start()
print(server.get_host_and_port()[1], flush=True)
sys.stdin.read()
"""


def recipe(machines: int) -> dict[str, Any]:
    """The recipe with that many machines."""
    return {**RECIPE, "machines": {**RECIPE["machines"], "count": machines, "runs_per_machine": RUNS_PER_MACHINE}}


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


def killed(machines: int, out: Path, folder: Path) -> int:
    """Make the set with four Dask workers, of which one is killed every few seconds. The number of kills."""
    kills, seen, done = [0], [0], threading.Event()
    with process(CLUSTER, folder) as started:
        address = said(started)

        def kill() -> None:
            while not done.wait(KILL_EVERY_S):
                size = sum(path.stat().st_size for path in (out / ".staging").glob("*/*/*.kept"))
                if started.stdin and size > seen[0]:  # something was kept since the last kill
                    seen[0] = size
                    started.stdin.write("kill\n")
                    started.stdin.flush()
                    kills[0] += bool(int(said(started)))

        killer = threading.Thread(target=kill)
        killer.start()
        try:
            rubgen.generate(recipe(machines), out, scheduler=address, progress=False)
        finally:
            done.set()
            killer.join()
    return kills[0]


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


def study(machines: int) -> str:
    """Do all and compose the table."""
    rows: list[list[str]] = []
    with TemporaryDirectory() as name:
        folder = Path(name)
        quiet, rough = folder / "quiet", folder / "rough"
        made = rubgen.generate(recipe(machines), quiet, workers=2, progress=False)
        data = rubgen.open(quiet)
        rows.append(["runs", f"{made.runs}: {', '.join(f'{count} {each}' for each, count in made.status.items())}"])
        splits = data.runs["split"].value_counts().items()
        rows.append(["splits", ", ".join(f"{each} {count}" for each, count in splits)])
        rows.append(["machines", str(data.runs["machine_id"].nunique())])
        rows.append(["kills", str(killed(machines, rough, folder))])
        before = digests(quiet)
        rows.append(["files with other bytes", f"{_different(before, digests(rough))} of {len(before)}"])
        rows.append(["problems that verify finds", str(len(rubgen.verify(quiet)))])
        rows.append(["equal when read from S3", "yes" if opened_at_s3(rough, folder) else "no"])
        rubgen.generate(recipe(machines + GROWN), quiet, workers=2, progress=False)
        grown = rubgen.open(quiet).runs
        kept = grown.iloc[: made.runs].equals(data.runs)
        rows.append([f"grown to {len(grown)} runs", f"old rows {'equal' if kept else 'changed'}"])
        rows.append(["problems that verify finds then", str(len(rubgen.verify(quiet)))])
    return table(["what", "found"], rows)


def _different(one: dict[str, str], other: dict[str, str]) -> int:
    return sum(one.get(name) != other.get(name) for name in one.keys() | other.keys())


def main() -> None:
    """Write the table to the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.cluster")
    parser.add_argument("--machines", type=int, default=200, help=f"each has {RUNS_PER_MACHINE} runs")
    text = study(parser.parse_args().machines)
    print(text)
    page = PAGE.read_text(encoding="utf-8")
    head, _, rest = page.partition(MARKS[0])
    _, _, tail = rest.partition(MARKS[1])
    PAGE.write_text(f"{head}{MARKS[0]}{text}{MARKS[1]}{tail}", encoding="utf-8")


if __name__ == "__main__":
    main()
