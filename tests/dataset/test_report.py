"""The page of a data set: what it says, that it stands alone, and how it looks in a browser."""

import base64
import io
import json
import re

import numpy as np
import pandas as pd
import pytest
from eyes import CHROMIUM, narrow_page, need, page_content, page_picture, printed_page
from PIL import Image

import rubgen
from rubgen.errors import UserError
from rubgen.report.page import example_runs, loading, write_report
from rubgen.viz.colors import MOTION_COLORS


@pytest.fixture(scope="module")
def page(small_set, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_report(small_set.directory, path)
    return path


def test_the_page_counts_the_runs_by_class(page, small_set):
    text = page.read_text(encoding="utf-8")
    runs = rubgen.open(small_set.directory).runs
    for motion, count in runs["motion"].value_counts().items():
        assert re.search(
            rf"background:{MOTION_COLORS[motion]}\"></span>{motion}</td><td class=\"number\">{count}</td>", text
        )
    assert "Passed: digest of the manifest" in text
    assert f"{len(runs)} simulated runs" in text
    assert text.count('<div class="card">') == 4
    for channel in rubgen.open(small_set.directory).signals("run-000000"):
        assert f"<td>{channel}</td>" in text


def test_the_page_stands_alone_and_is_small(page):
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"(?:src|href)=\"(?!data:)", text)
    assert "url(" not in text
    assert ".bar, .dot { print-color-adjust: exact;" in text  # else printers leave the colours of the classes out
    assert page.stat().st_size < 5e6


def figures_of(page):
    """The figures that plotly.js draws."""
    text = page.read_text(encoding="utf-8")
    return [json.loads(each) for each in re.findall(r'<script type="application/json">(.*?)</script>', text, re.DOTALL)]


def test_the_page_has_figures_to_zoom_and_turn(page, small_set):
    from rubgen.dataset.reading.replaying import find_replay
    from rubgen.reduction import reduce
    from rubgen.viz.derived import poincare_section

    campbell, orbits = figures_of(page)[:2]
    lines = campbell["data"]
    forward = [line for line in lines if "ND 1 forward" in line.get("hovertemplate", "")]
    first = next(line for line in lines if line["name"] == "1X")
    speeds = np.array(forward[0]["x"])
    above = [np.array([np.nan if y is None else y for y in line["y"]]) - speeds / 60 for line in forward]
    met = [speeds[i] for each in above for i in np.flatnonzero(each[:-1] * each[1:] < 0)]
    title = orbits["layout"]["title"]["text"]
    shown = find_replay(small_set.directory, title.split(":")[0]).replay
    critical = reduce(shown.scenario.machine, shown.scenario.reduction).critical_speed_rpm
    assert [0 < critical - speed < speeds[1] for speed in met] == [True]
    assert first["y"][1] == pytest.approx(first["x"][1] / 60)
    assert "rev/min" in title
    once = poincare_section(shown)
    np.testing.assert_allclose(orbits["data"][1]["x"], once[0, -len(orbits["data"][1]["x"]) :], rtol=1e-4)
    assert [trace["visible"] for trace in orbits["data"]].count(True) == 2
    assert len(orbits["layout"]["updatemenus"][0]["buttons"]) == len(orbits["data"]) / 2


def test_a_browser_draws_the_figures_without_a_network(page, tmp_path):
    need(CHROMIUM, "chromium")
    places = page.read_text(encoding="utf-8").count('<div class="turn">')
    drawing = "for (const place of document.querySelectorAll('.turn')) { seen.unobserve(place); draw(place); }"
    copy = tmp_path / "drawn.html"
    copy.write_text(page.read_text(encoding="utf-8") + f"<script>{drawing}</script>", encoding="utf-8")
    drawn = page_content(copy, tmp_path)
    assert len(re.findall(r'<div class="turn js-plotly-plot">', drawn)) == places
    assert drawn.count('class="updatemenu-header"') == places - 1


def test_the_ways_to_load_work(small_set):
    from rubgen.dataset.reading.replaying import find_replay

    data = rubgen.open(small_set.directory)
    ways = loading(data, find_replay(small_set.directory, "run-000000").replay)
    assert set(ways) == {"rubgen", "pandas", "polars", "datasets", "torch", "MCAP"}
    expected = data.signals("run-000000")["proximity_x"]
    for name in ("rubgen", "pandas", "polars", "MCAP"):
        namespace = {}
        exec(ways[name].replace("DIR", str(small_set.directory)), namespace)  # noqa: S102 - our own lines
        np.testing.assert_array_equal(np.asarray(namespace["signal"]), expected)


def test_pictures_keep_the_colours_of_the_classes(page):
    """A palette of few colours would turn rare ones into others."""
    pictures = re.findall(r"data:image/png;base64,([^\"]+)", page.read_text(encoding="utf-8"))
    assert len(pictures) >= 2
    with Image.open(io.BytesIO(base64.b64decode(pictures[0]))) as image:
        colors = {
            f"#{r:02x}{g:02x}{b:02x}" for r, g, b in np.unique(np.asarray(image.convert("RGB")).reshape(-1, 3), axis=0)
        }
    assert colors & set(MOTION_COLORS.values())


def test_examples_show_each_class_and_a_run_without_contact():
    motions = ["period-1", "chaotic", "chaotic", "period-1", "quasi-periodic", "period-1", "period-1", "period-1"]
    impulses = [0.0, 3.0, 5.0, 2.0, 1.0, 0.0, 1.5, 0.5]
    runs = pd.DataFrame(
        {
            "motion": motions,
            "contact_impulse_per_turn_n_s": impulses,
            "rub": [impulse > 0 for impulse in impulses],
        },
        index=pd.Index([f"run-{index:06d}" for index in range(8)], name="run"),
    )
    runs["run_id"] = runs.index
    assert example_runs(runs) == [f"run-{index:06d}" for index in (3, 4, 2, 0, 1, 6)]


def test_a_failed_run_is_listed_with_its_reason(small_set, tmp_path, monkeypatch):
    runs = rubgen.open(small_set.directory).runs.copy()
    runs.loc["run-000003", ["status", "reason"]] = "diverged", "blade 3 <bent> in turn 7"
    monkeypatch.setattr("rubgen.dataset.reading.open.DataSet.runs", runs)
    monkeypatch.setattr("rubgen.report.page.verify", lambda _directory: ["data: broken"])
    write_report(small_set.directory, tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert " more.</p>" not in text
    assert "<td>run-000003</td><td>diverged</td><td>blade 3 &lt;bent&gt; in turn 7</td>" in text
    assert "1 problems" in text
    runs.loc["run-000002", ["status", "reason"]] = "refused", "too fast"
    monkeypatch.setattr("rubgen.report.page.MOST_FAILED", 1)
    write_report(small_set.directory, tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<td>run-000002</td><td>refused</td>" in text
    assert "<td>run-000003</td><td>diverged</td>" not in text
    assert "<p>and 1 more.</p>" in text


def test_a_flipped_bit_of_an_mcap_stands_on_the_page_and_costs_no_page(shown_set, copied_shown_set, tmp_path):
    path = copied_shown_set / "mcap/0000/run-000000.mcap"
    for part in (3, 5, 7):
        content = bytearray((shown_set / "mcap/0000/run-000000.mcap").read_bytes())
        content[part * len(content) // 10] ^= 4
        path.write_bytes(content)
        write_report(copied_shown_set, tmp_path / "report.html")
        text = (tmp_path / "report.html").read_text(encoding="utf-8")
        assert "mcap/0000/run-000000.mcap: its sha256 is not the one in the manifest" in text
        assert "mcap/0000/run-000000.mcap: damaged (" in text
        assert "Passed: digest" not in text


def test_a_directory_without_a_set_is_refused(tmp_path):
    with pytest.raises(UserError, match="no finished data set of rubgen"):
        write_report(tmp_path, tmp_path / "report.html")


@pytest.mark.parametrize("width", [360, 1200])
def test_nothing_overflows_and_the_console_is_silent(page, tmp_path, width):
    need(CHROMIUM, "chromium")
    content, frame, console = narrow_page(page, tmp_path, width)
    assert content <= frame <= width
    assert console == ""


def test_light_dark_and_print_can_be_looked_at(page, tmp_path):
    need(CHROMIUM, "chromium")
    means = []
    for options in ((), ("--blink-settings=preferredColorScheme=0",)):
        with Image.open(page_picture(page, tmp_path, *options)) as image:
            picture = np.asarray(image.convert("L"))
        assert np.unique(picture).size > 100
        means.append(float(np.median(picture)))
    light, dark = means
    assert light > 200
    assert dark < 60
    assert printed_page(page, tmp_path).startswith(b"%PDF")
