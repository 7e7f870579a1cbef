"""`rubgen doctor`: what is found, and 1 where the main job cannot run."""

import importlib.metadata
import json

import pytest

from rubgen import cache_root
from rubgen.cli import doctor, main


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
        return "1.0"

    monkeypatch.setenv(cache_root.CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(doctor, "version", without_scipy)
    code, out = told(capsys, "--json")
    assert code == 1
    assert json.loads(out)["problems"] == ["scipy: not installed; install rubgen again"]
