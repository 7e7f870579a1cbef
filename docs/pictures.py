"""The pictures of the documentation, each made by rubgen itself: `make pictures`, some five minutes on two cores.

The one of the viewer needs a graphics driver, a real one or Debian's mesa-vulkan-drivers; without one it stays.
"""

from __future__ import annotations

import io
import socket
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

import rubgen
from rubgen.report.figures import Choice, make_figure
from rubgen.scenario.load import RECIPES
from rubgen.scenario.surroundings import Surroundings, Tone
from rubgen.viz.figures import overview, save_png
from rubgen.viz.replay import Replay, replay_of
from rubgen.viz.rerun import write_replay

DOCS = Path(__file__).parent
OUT = DOCS.parent / "out"
TOP_BAR = 36
"""Pixels of the viewer's own bar, which is cut off."""


def main() -> None:
    """Simulate the runs, and make or take the data set of the sweep."""
    run = rubgen.simulate(rubgen.make_scenario("zeng2019", speed_rpm=8500))
    save_png(overview(run), DOCS / "overview.png")
    save_viewer(replay_of(run), DOCS / "replay.png")
    save_png(surroundings_figure(), DOCS / "surroundings.png")
    rubgen.generate(RECIPES / "speed-sweep.toml", OUT / "speed-sweep")
    save_png(make_figure("bifurcation", OUT / "speed-sweep", Choice()), DOCS / "bifurcation.png")


def surroundings_figure() -> Figure:
    """Spectra of an accelerometer on the casing with and without a rub, in silence and in a plant."""
    figure = Figure(figsize=(9, 6), layout="constrained")
    silent = rubgen.make_scenario("zeng2019", speed_rpm=10_500)
    plant = Surroundings(background_m_per_s2=30, blade_passing_m_per_s2=20, tones=(Tone(order=3.2, level_m_per_s2=10),))
    free = rubgen.make_scenario("zeng2019", speed_rpm=10_500, clearance_m=2e-3)
    for axes, scenario, name in zip(figure.subplots(2, sharex=True), (silent, free), ("rub", "no rub"), strict=True):
        for around, label in ((plant, "in a plant"), (None, "in silence")):
            run = rubgen.simulate(replace(scenario, surroundings=around))
            values = run.recording.channels["casing_acc_0"].values if run.recording else np.zeros(1)
            window = np.hanning(values.size)
            amplitude = 2 * np.abs(np.fft.rfft(values * window)) / window.sum()
            axes.semilogy(np.arange(amplitude.size) / 1e3, amplitude, linewidth=0.6, label=label)
        axes.set(title=name, ylabel="m/s2, peak", ylim=(1e-3, None))
        axes.legend(loc="upper right")
    axes.set(xlabel="kHz")
    return figure


def save_viewer(replay: Replay, path: Path) -> None:
    """What `rubgen replay` opens, at the hardest touch, drawn without a screen."""
    from rerun.experimental import ViewerClient

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    program = str(Path(sys.executable).with_name("rerun"))
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "run.rrd"
        write_replay(replay, recording)
        try:
            viewer = ViewerClient.spawn(headless=True, port=port, hide_welcome_screen=True, executable_path=program)
        except RuntimeError as error:
            sys.stderr.write(f"{path}: left as it is, for the viewer does not start without a screen ({error})\n")
            return
        try:
            viewer.open(str(recording))
            while viewer.get_state().loading:
                time.sleep(0.1)
            viewer.set_time("time", duration=replay.hardest_touch, play_state="paused")
            time.sleep(8)  # meshes and spectra come some frames after their views
            with Image.open(io.BytesIO(viewer.take_screenshot())) as image:
                seen = image.convert("RGB").crop((0, TOP_BAR, image.width, image.height))
        finally:
            viewer.quit()
    # A palette, for a file below 300 kB; drawn towards means of clusters, or rare colours would turn into others.
    seen.quantize(256, kmeans=2, dither=Image.Dither.NONE).save(path, optimize=True)


if __name__ == "__main__":
    main()
