from dataclasses import replace

import pytest

from rubgen.machine import load_machine


@pytest.fixture(autouse=True, scope="session")
def own_cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RUBGEN_CACHE_DIR", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="session")
def preset():
    return load_machine("zeng2019")


@pytest.fixture(scope="session")
def small(preset):
    """A coarse machine of three blades, small enough for dense full-model solutions."""
    disk = replace(preset.disk, radial_elements=1, circumferential_elements=6)
    return replace(preset, disk=disk, blades=replace(preset.blades, count=3, elements=2))
