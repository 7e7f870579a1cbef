"""Recordings in the viewer itself, without a screen: no view complains, and something is to be seen."""

import io
import socket
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from eyes import SOFTWARE_VULKAN, need
from PIL import Image

from rubgen.io.mcap import write_mcap
from rubgen.viz.replay import replay_of
from rubgen.viz.rerun import write_rrd


@pytest.fixture(scope="module")
def viewer():
    need(SOFTWARE_VULKAN, "mesa-vulkan-drivers")
    from rerun.experimental import ViewerClient

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    program = Path(sys.executable).with_name("rerun")
    client = ViewerClient.spawn(headless=True, port=port, executable_path=str(program))
    yield client
    client.quit()


def opened(viewer, path):
    """Open a file alone; its views once all is loaded."""
    viewer.open(str(path))
    for _ in range(100):
        state = viewer.get_state()
        if state.views and not state.loading:
            return state.views
        time.sleep(0.1)
    raise AssertionError("no view within ten seconds")


def drawn(viewer, wanted, colours):
    """Pixels of the wanted view, once it shows more than so many colours: meshes and images come some frames after it.

    It is looked for at every try, for views that the viewer arranges by itself are made anew while a file loads.
    """
    seen = 0
    for _ in range(40):
        view = next((view for view in viewer.get_state().views if wanted(view)), None)
        try:
            picture = viewer.take_screenshot(view.view_id) if view else None
        except ConnectionError:  # the view has gone
            picture = None
        if picture:
            with Image.open(io.BytesIO(picture)) as image:
                shown = np.asarray(image.convert("RGB")).reshape(-1, 3)
            seen = len(np.unique(shown, axis=0))
            if seen > colours:
                return shown
        time.sleep(0.5)
    raise AssertionError(f"the view shows {seen} colours after 20 seconds")


def complaints(viewer):
    """Reports of all views, each tab in front once: a view that is behind is not drawn and reports nothing."""
    arranged, found = viewer.get_blueprint().blueprint, []
    tabs = {
        path: parts["ContainerBlueprint"]
        for path, parts in arranged.items()
        if parts.get("ContainerBlueprint", {}).get("container_kind") == "Tabs"
    }
    for place in range(max(len(tab["contents"]) for tab in tabs.values())):
        front = {
            path: {"ContainerBlueprint": {**tab, "active_tab": tab["contents"][min(place, len(tab["contents"]) - 1)]}}
            for path, tab in tabs.items()
        }
        viewer.set_blueprint(arranged | front, "recording")
        time.sleep(0.3)
        viewer.take_screenshot(max_size=64)
        found += [(view.name, view.reports) for view in viewer.get_state().views if view.reports]
    return found


def test_no_view_of_a_replay_complains_and_the_machine_is_seen(viewer, rub_run, tmp_path):
    write_rrd(rub_run, tmp_path / "run.rrd")
    views = opened(viewer, tmp_path / "run.rrd")
    assert {view.view_class for view in views} >= {
        "3D", "2D", "TimeSeries", "BarChart", "Tensor", "StateTimeline", "TextDocument",
    }  # fmt: skip
    viewer.set_time("time", duration=float(replay_of(rub_run).frames.time[100]), play_state="paused")
    shown = drawn(viewer, lambda view: view.name == "machine, deviations × 10", 500)
    steel = (shown.min(axis=1) > 90) & (np.ptp(shown, axis=1) < 60)
    assert steel.mean() > 0.05
    assert complaints(viewer) == []


@pytest.mark.parametrize("name", ["free_run", "rig_run"])
def test_a_run_without_contact_and_one_of_a_rig_have_no_complaint_either(viewer, name, request, tmp_path):
    write_rrd(request.getfixturevalue(name), tmp_path / "run.rrd")
    opened(viewer, tmp_path / "run.rrd")
    assert complaints(viewer) == []


def test_an_mcap_file_alone_shows_its_previews(viewer, rub_run, tmp_path):
    write_mcap(rub_run, tmp_path / "run.mcap")
    views = opened(viewer, tmp_path / "run.mcap")
    assert {"/preview/acceleration", "/preview/contact_force"} <= {view.origin for view in views}
    assert [view.reports for view in views if view.reports] == []
    drawn(viewer, lambda view: view.origin == "/preview/acceleration", 50)
