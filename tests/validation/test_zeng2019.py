import json

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigvals
from scipy.sparse.linalg import spsolve

from rubgen.errors import UserError
from rubgen.fem.constraints import on_springs, support_stiffness
from rubgen.machine.published import CASING_HZ
from rubgen.units import rad_per_s
from validation.zeng2019 import reproduce
from validation.zeng2019.models.full import _around, critical_speed, full_blisk
from validation.zeng2019.models.mode_shapes import nodal_diameters
from validation.zeng2019.models.reduced import seen_frequencies, whirl
from validation.zeng2019.reproducing import sections_of
from validation.zeng2019.sections import SECTIONS
from validation.zeng2019.statement import Statement, by_deviation, by_share, power

FIELDS = {*Statement.__dataclass_fields__, "figure", "machine", "command"}
VERDICTS = ("agrees", "agrees within ", "differs", "unknowable")


def test_a_number_agrees_within_its_deviation():
    assert by_deviation(-0.004) == "agrees"
    assert by_deviation(0.031) == "agrees within 3.1 %"
    assert by_deviation(-0.06) == "differs"
    assert by_deviation(0.03, tolerance=0.02) == "differs"


def test_a_statement_about_runs_agrees_by_its_share():
    assert [by_share(n, 20) for n in (20, 18, 15, 10, 9)] == [
        "agrees",
        "agrees",
        "agrees within 25 % of the runs",
        "agrees within 50 % of the runs",
        "differs",
    ]
    assert by_share(0, 0) == "unknowable"


def test_no_other_verdict_is_possible():
    with pytest.raises(ValueError, match="must be one of"):
        Statement(statement="x", verdict="looks good", found="y")


def test_a_wrong_directory_is_refused(tmp_path):
    file = tmp_path / "file"
    file.write_text("x")
    with pytest.raises(UserError, match=r"--out .*file: is a file; give a new or empty directory"):
        reproduce(file, figure="9")
    with pytest.raises(UserError, match=r"not empty and not made by this command; give a new"):
        reproduce(tmp_path, figure="9")
    assert file.read_text() == "x"
    with pytest.raises(UserError, match=r"--out .*file.*: cannot be written .*; give a directory you may write to"):
        reproduce(file / "below", figure="9")


def test_an_unknown_figure_is_refused(tmp_path):
    with pytest.raises(UserError, match=r"--figure 5: there is no such figure; choose from 6, 7, 8, 9"):
        reproduce(tmp_path / "new", figure="5")
    assert not (tmp_path / "new").exists()


def test_every_section_has_its_own_name():
    names = [name for section in SECTIONS for name in (section.name, *section.also)]
    assert len(set(names)) == len(names)
    assert all(sections_of(name) for name in names)


def test_numbers_are_written_without_a_plus():
    assert [power(value) for value in (1.4e8, 266.0, 2.27e4, 1e-6)] == ["1.4e8", "266", "2.27e4", "1e-6"]
    assert power(1.2994e8, 4) == "1.299e8"


def test_the_full_model_meets_no_stiffness_at_its_critical_speed():
    """Right at it an unbalance moves the disk centre without bound, on either side in opposite directions.

    The reduced model has 8,776 rev/min (docs/preset-zeng2019.md).
    """
    rpm = float(critical_speed()["rpm"])
    assert rpm == pytest.approx(8776, rel=2e-3)
    machine, model = full_blisk()
    K = on_springs(model.K, support_stiffness(machine.disk_support))
    load = np.zeros(K.shape[0])
    load[0] = 1.0
    below, above = (spsolve(sp.csc_array(K + rad_per_s(w) ** 2 * (model.K_sigma - model.S)), load)[0]
                    for w in (0.999 * rpm, 1.001 * rpm))  # fmt: skip
    assert below > 100 / 1e8
    assert above < -100 / 1e8


def test_a_figure_makes_its_page(tmp_path):
    made = reproduce(tmp_path / "out", figure="9", workers=1)
    folder = tmp_path / "out" / "figure-9"
    assert made.page == folder / "zeng2019.md"
    text, html = made.page.read_text(), (folder / "zeng2019.html").read_text()
    statements = json.loads((folder / "statements.json").read_text())
    assert sum(made.verdicts.values()) == len(statements) == 2
    for one in statements:
        assert set(one) == FIELDS
        assert one["machine"] == "zeng2019"
        assert one["verdict"].startswith(VERDICTS)
        assert one["statement"] in text
        assert one["command"] == "python -m validation.zeng2019 --figure 9"
    assert str(CASING_HZ[-1]) in statements[0]["statement"]
    assert "(zeng2019-9a.png)" in text
    assert (folder / "zeng2019-9a.png").stat().st_size < 100_000
    assert "data:image/png;base64," in html
    assert reproduce(tmp_path / "out", figure="9", workers=1).made == 0


def test_eigenvalues_around_a_shift_are_those_of_the_dense_problem():
    rng, n = np.random.default_rng(3), 60
    A, B, G = (rng.standard_normal((n, n)) for _ in range(3))
    M, K, C = A @ A.T + n * np.eye(n), 900 * (B @ B.T + n * np.eye(n)), 40 * (G - G.T)
    state = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    every, shift = eigvals(state), 30j
    nearest = every[np.argsort(np.abs(every - shift))]
    found = _around(sp.csr_array(M), sp.csr_array(C), sp.csr_array(K), shift)
    np.testing.assert_allclose(np.sort(found.imag), np.sort(nearest[: len(found)].imag), rtol=1e-6, atol=1e-6)


def test_nodal_diameters_are_wave_numbers():
    angle = 2 * np.pi * np.arange(36) / 36
    waves = np.stack([np.cos(n * angle + 0.3) for n in (0, 1, 7, 18)], axis=-1)
    assert nodal_diameters(waves[:, None]).tolist() == [0, 1, 7, 18]


def test_whirl_of_a_point_mass_is_seen_at_its_frequency_from_outside():
    """A mass on equal springs, seen from the turning frame, whirls at +-omega in the inertial one at any speed.

    M = 1, C = 2 Omega J, K = omega^2 - Omega^2, J = e_z x; tips that it carries along have u_k = x cos + y sin.
    """
    blades, speed, omega = 8, 3.0, 5.0
    angle = 2 * np.pi * np.arange(blades) / blades
    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    values, vectors = whirl(np.eye(2), 2 * speed * J, (omega**2 - speed**2) * np.eye(2))
    tips = np.zeros((blades, 3, 4), dtype=complex)
    tips[:, 0] = np.column_stack([np.cos(angle), np.sin(angle)]) @ vectors
    seen = seen_frequencies(values, tips.reshape(3 * blades, 4), blades, speed)
    assert np.sort(seen) == pytest.approx([-omega, omega])
