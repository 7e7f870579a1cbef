"""`rubgen doctor`: what is found, and 1 where the main job cannot run."""

import importlib.metadata
import json

import pytest

from rubgen import cache_root
from rubgen.cli import main
from rubgen.cli.commands import doctor


def told(capsys, *options: str) -> tuple[int, str]:
    with pytest.raises(SystemExit) as end:
        main(["doctor", *options])
    return end.value.code, capsys.readouterr().out


def test_it_says_what_is_there(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv(cache_root.CACHE_VARIABLE, str(tmp_path))
    code, out = told(capsys, "--json")
    found = json.loads(out)
    assert code == 0
    assert found["ok"]
    assert found["cache"] == str(tmp_path)
    assert found["cache_writable"]
    assert {"numba", "scipy", "rerun-sdk", "llvmlite"} <= set(found["packages"])
    assert found["usable_cores"] >= 1
    assert found["vulkan"] in ("hardware", "software", "none")


def test_a_cache_that_cannot_be_used_costs_no_main_job(tmp_path, monkeypatch, capsys):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv(cache_root.CACHE_VARIABLE, str(tmp_path / "file" / "x"))
    code, out = told(capsys)
    assert code == 0
    assert "RUBGEN_CACHE_DIR names another" in out


def test_a_missing_package_is_named(tmp_path, monkeypatch, capsys):
    def without_scipy(name):
        if name == "scipy":
            raise importlib.metadata.PackageNotFoundError(name)
        return importlib.metadata.version(name)

    monkeypatch.setenv(cache_root.CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(doctor, "version", without_scipy)
    code, out = told(capsys, "--json")
    assert code == 1
    assert json.loads(out)["problems"] == ["scipy: not installed; install rubgen again"]


@pytest.mark.parametrize(
    ("installed", "wrong"),
    [
        ({"scipy": "1.15.3"}, ["scipy: version 1.15.3 is installed, rubgen needs >=1.16; install rubgen again"]),
        ({"scipy": "1.16.0rc1"}, ["scipy: version 1.16.0rc1 is installed, rubgen needs >=1.16; install rubgen again"]),
        ({"numba": "0.70.0"}, ["numba: version 0.70.0 is installed, rubgen needs <0.70,>=0.68; install rubgen again"]),
        ({"scipy": "1.100", "numpy": "2.0.0.post1", "llvmlite": "0.1"}, []),
    ],
)
def test_a_version_outside_of_the_declared_ones_is_named(tmp_path, monkeypatch, capsys, installed, wrong):
    monkeypatch.setenv(cache_root.CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(doctor, "requires", lambda _: ["numpy>=2.0", "scipy>=1.16", "numba>=0.68,<0.70", "llvmlite"])
    usual = {"numpy": "2.3.0", "scipy": "1.16.1", "numba": "0.69.1", "llvmlite": "0.46.0"}
    monkeypatch.setattr(doctor, "version", (usual | installed).__getitem__)
    code, out = told(capsys, "--json")
    assert (code, json.loads(out)["problems"]) == (1 if wrong else 0, wrong)
