"""The layout for Foxglove names topics, fields and lines that an MCAP file of the demo's sensors really has."""

import json
import re
import sys

import pytest

from rubgen.cli import main
from rubgen.io.mcap import write_mcap
from rubgen.io.mcap.content import decoded, read_content
from rubgen.io.mcap.foxglove import read_multi_array
from rubgen.io.mcap.layout import foxglove_layout
from rubgen.sensors.load import load_sensor_set

VALUE = re.compile(r"(/[\w/]+)\.(\w+)(?:\[(\d+)\])?")


@pytest.fixture
def mcap(rub_run, tmp_path):
    path = tmp_path / "run.mcap"
    write_mcap(rub_run, path)
    return path


def panels_of(tree):
    return [tree] if isinstance(tree, str) else [*panels_of(tree["first"]), *panels_of(tree["second"])]


def test_every_line_is_a_field_of_a_message_in_the_file(rub_run, mcap):
    assert rub_run.scenario.sensing.set == load_sensor_set("default")
    layout, content = foxglove_layout(rub_run.recording), read_content(mcap)
    paths = [path for panel in layout["configById"].values() for path in panel.get("paths", [])]
    assert len(paths) >= 2 * len(rub_run.recording.channels) + 6
    for path in paths:
        topic, field, place = VALUE.fullmatch(path["value"]).groups()
        (message, *_) = content.messages[topic]
        if place is None:
            assert field in type(decoded(content, topic)[0]).DESCRIPTOR.fields_by_name, path
        else:
            names, _ = read_multi_array(message.data)
            assert field == "data"
            assert path["label"].partition(",")[0] == names[int(place)].replace(".", " ")


def test_every_preview_has_a_plot_and_every_panel_a_place(rub_run, mcap):
    layout = foxglove_layout(rub_run.recording)
    plots = [panel for panel in layout["configById"].values() if "paths" in panel]
    shown = {path["value"].partition(".")[0] for plot in plots for path in plot["paths"]}
    assert set(read_content(mcap).topics("/preview/")) <= shown
    assert sorted(panels_of(layout["layout"])) == sorted(layout["configById"])


def test_both_viewers_find_the_title_of_each_plot_under_their_own_key(rub_run):
    panels = foxglove_layout(rub_run.recording)["configById"].values()
    titles = [(each["foxglovePanelTitle"], each["lichtblickPanelTitle"]) for each in panels if "paths" in each]
    assert ("touches", "touches") in titles
    assert all(first == second for first, second in titles)


def test_the_command_writes_it_for_an_mcap_file(rub_run, mcap, tmp_path, capsys):
    with pytest.raises(SystemExit) as ended:
        sys.exit(main(["replay", str(mcap), "--foxglove", str(tmp_path / "layout.json")]))
    assert ended.value.code == 0
    assert "import this layout" in capsys.readouterr().out
    assert json.loads((tmp_path / "layout.json").read_text()) == foxglove_layout(rub_run.recording)
