from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from validation.contact_options.__main__ import main
from validation.contact_options.blade_shortening import draw_in_matrix, soft_draw_in
from validation.contact_options.chords import artefact
from validation.contact_options.draw_in import draw_in


def test_a_uniform_beam_draws_back_by_three_fifths_of_its_deflection_squared_over_its_length():
    preset = load_machine("zeng2019")
    blades = replace(
        preset.blades, tip_chord_m=4e-2, root_chord_m=4e-2, tip_thickness_m=2e-3, root_thickness_m=2e-3,
        root_angle_deg=90.0, tip_angle_deg=90.0, elements=40,
    )  # fmt: skip
    Q, _ = draw_in_matrix(blades, 0.25)
    assert Q[0, 0] == pytest.approx(0.6 / 0.15, rel=2e-3)
    assert draw_in(Q, np.array([[2e-3, 0.0]])) == pytest.approx([4e-6 * Q[0, 0]])
    assert soft_draw_in(blades, 0.25) == pytest.approx(Q[0, 0], rel=1e-6)


def test_chords_of_the_preset_hit_a_tip_by_two_degrees_of_its_speed_at_every_node():
    machine = load_machine("zeng2019")
    round_casing = replace(machine, casing=replace(machine.casing, ovality_m=0.0))
    hits = artefact(reduce(round_casing, Reduction()).at_speed(1047.0), points=3600)
    # A chord of 2 degrees leaves the circle by 1 degree on either side.
    assert hits.hits == pytest.approx(np.full(180, 2 * np.tan(np.pi / 180) * 1047.0 * 0.4002723), rel=1e-4)
    assert hits.hits.mean() == pytest.approx(15, abs=0.5)
    assert hits.inside.max() == pytest.approx(0.4002723 * (1 - np.cos(np.pi / 180)), rel=5e-3)


def test_the_page_is_written_with_its_figures(tmp_path, capsys):
    assert main(["--quick"], tmp_path) == 0
    out = tmp_path / "out" / "contact-options-quick"
    assert {path.name for path in out.iterdir()} == {
        "contact-options.md",
        "contact-options-chords.png",
        "contact-options-liner.png",
    }
    text = (out / "contact-options.md").read_text()
    assert "| 8,820 |" in text
    assert "chords" in capsys.readouterr().out
