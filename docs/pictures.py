"""The pictures of the documentation, each made by rubgen itself: `make pictures`."""

from __future__ import annotations

from pathlib import Path

import rubgen
from rubgen.viz.figures import dataset_overview, overview, save_png

DOCS = Path(__file__).parent
DATA_SET = DOCS.parent / "out" / "demo"
RUNS: dict[str, dict[str, float]] = {
    "overview": {"speed_rpm": 8500},
    "period-1": {"speed_rpm": 10500},
    "three-lobes": {"speed_rpm": 9000, "lobes": 3},
}


def main() -> None:
    """Simulate the named runs, take the data set of `make demo` (made here when it is missing), write docs/*.png."""
    for name, values in RUNS.items():
        run = rubgen.simulate(rubgen.make_scenario("zeng2019", **values))
        save_png(overview(run), DOCS / f"{name}.png")
    rubgen.generate(None, DATA_SET)
    save_png(dataset_overview(rubgen.open(DATA_SET).runs), DOCS / "data-set.png")


if __name__ == "__main__":
    main()
