"""One variable moves every cache."""

import pytest

from rubgen.cache_root import CACHE_VARIABLE, cache_root
from rubgen.jit import kernel_cache_dir
from rubgen.reduction.cache import cache_directory


@pytest.fixture
def fresh_kernel_dir():
    kernel_cache_dir.cache_clear()
    yield
    kernel_cache_dir.cache_clear()


def test_the_variable_moves_kernels_and_blisks(tmp_path, monkeypatch, fresh_kernel_dir):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    assert cache_root() == tmp_path
    assert cache_directory() == tmp_path / "reduction"
    assert kernel_cache_dir().parent == tmp_path / "kernels"


def test_an_empty_variable_is_none(monkeypatch):
    monkeypatch.setenv(CACHE_VARIABLE, "")
    assert cache_root().name == "rubgen"
