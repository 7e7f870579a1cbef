"""The cache of reduced blisks: the same bits, nothing stale, nothing fatal."""

import errno
from dataclasses import replace

import pytest

from rubgen import cache_root
from rubgen.errors import RubgenWarning
from rubgen.reduction import cache
from rubgen.reduction.blisk import reduce_blisk
from rubgen.scenario import Reduction

MODES = Reduction(blade_modes=1, disk_modes=1, blisk_modes=1)


@pytest.fixture
def calls(tmp_path, monkeypatch):
    """An empty cache, and the list of reductions that were really made."""
    made = []

    def counted(*what):
        made.append(what)
        return reduce_blisk(*what)

    monkeypatch.setenv("RUBGEN_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "reduce_blisk", counted)
    return made


def take(machine, reduction=MODES):
    return cache.cached_blisk(machine.disk, machine.blades, machine.disk_support, reduction)


def bits(blisk):
    arrays = [getattr(blisk, name) for name in ("M", "K", "G", "A", "centre", "rigid_inertia")]
    arrays += [getattr(blisk.growth, name) for name in ("K", "A", "f", "tips")]
    return [(a.tobytes(), a.shape, a.flags.c_contiguous) for a in arrays] + [blisk.blade_frequency, blisk.full_size]


def test_warm_has_the_bits_of_cold_and_is_made_once(small, calls):
    cold, warm = take(small), take(small)
    assert len(calls) == 1
    assert bits(cold) == bits(warm)


def test_what_enters_makes_another_entry(small, calls):
    take(small)
    take(replace(small, disk=replace(small.disk, rim_thickness_m=0.05)))
    take(replace(small, blades=replace(small.blades, tip_angle_deg=70.0)))
    take(replace(small, disk_support=replace(small.disk_support, tilt_stiffness_nm_per_rad=4e5)))
    take(small, replace(MODES, blade_modes=2))
    assert len(calls) == 5
    assert len(list(cache.cache_folder("reduction").glob("*.blisk"))) == 5


def test_what_does_not_enter_shares_the_entry(small, calls):
    take(small)
    take(replace(small, disk_support=replace(small.disk_support, lateral_stiffness_n_per_m=5e8)))
    take(small, replace(MODES, casing_modes=13))
    assert len(calls) == 1


def test_other_code_makes_another_entry(small, calls, tmp_path, monkeypatch):
    take(small)
    for folder in ("fem", "reduction", "machine"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "code.py").write_text("changed = True\n")
    monkeypatch.setattr(cache, "_PACKAGE", tmp_path)
    take(small)
    assert len(calls) == 2


@pytest.mark.parametrize("damage", ["empty", "truncated", "garbage", "flipped"])
def test_a_damaged_file_is_made_anew(small, calls, damage):
    good = bits(take(small))
    (path,) = cache.cache_folder("reduction").glob("*.blisk")
    content = path.read_bytes()
    middle = len(content) // 2
    flipped = content[:middle] + bytes([content[middle] ^ 255]) + content[middle + 1 :]
    path.write_bytes({"empty": b"", "truncated": content[:middle], "garbage": b"no zip", "flipped": flipped}[damage])
    cache_root._say_once.cache_clear()
    with pytest.warns(RubgenWarning, match="RUBGEN_CACHE_DIR") as said:
        assert bits(take(small)) == good
    assert len(said) == 1
    assert len(calls) == 2
    assert path.read_bytes() == content
    assert not list(cache.cache_folder("reduction").glob("*.tmp"))


def test_where_nothing_can_be_kept_it_is_made_each_time(small, calls, monkeypatch):
    monkeypatch.setattr(cache, "cache_folder", lambda _name: None)
    assert bits(take(small)) == bits(take(small))
    assert len(calls) == 2


@pytest.mark.parametrize("error", [OSError(errno.ENOLCK, "No locks available"), NotImplementedError("no flock")])
def test_where_files_cannot_be_locked_it_is_kept_all_the_same(small, calls, monkeypatch, error):
    def refuse(_lock):
        raise error

    monkeypatch.setattr(cache.FileLock, "acquire", refuse)
    assert bits(take(small)) == bits(take(small))
    assert len(calls) == 1


def test_a_lock_of_a_process_that_never_ends_is_not_waited_for(small, calls, monkeypatch):
    good = bits(take(small))
    (path,) = cache.cache_folder("reduction").glob("*.blisk")
    path.unlink()
    monkeypatch.setattr(cache, "PATIENCE_S", 0.1)
    with cache.FileLock(path.with_suffix(".lock")):
        assert bits(take(small)) == good
    assert len(calls) == 2


def test_a_folder_in_the_place_of_the_lock_costs_nothing(small, calls):
    good = bits(take(small))
    (path,) = cache.cache_folder("reduction").glob("*.blisk")
    path.unlink()
    path.with_suffix(".lock").unlink(missing_ok=True)
    path.with_suffix(".lock").mkdir()
    assert bits(take(small)) == bits(take(small)) == good
    assert len(calls) == 2


def test_a_file_without_seal_is_not_believed(small, calls):
    good = bits(take(small))
    (path,) = cache.cache_folder("reduction").glob("*.blisk")
    path.write_bytes(path.read_bytes()[32:])
    cache_root._say_once.cache_clear()
    with pytest.warns(RubgenWarning, match="RUBGEN_CACHE_DIR"):
        assert bits(take(small)) == good
