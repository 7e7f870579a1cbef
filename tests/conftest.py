import pytest


def pytest_collection_modifyitems(items):
    """Long modules come first, so that all processes end at about the same time."""
    items.sort(key=lambda item: item.get_closest_marker("long") is None)


@pytest.fixture(scope="session")
def make_synthetic_run():
    """Makes runs with made-up signals (tests of files and pictures); imported late, for it needs the whole pipeline."""
    from synthetic import make_run

    return make_run


@pytest.fixture(scope="session")
def rub_run(make_synthetic_run):
    return make_synthetic_run()


@pytest.fixture(scope="session")
def rig_run(make_synthetic_run):
    """The same with the sensors of a rig: other kinds, units, clocks, and events of timing probes."""
    return make_synthetic_run(sensors="rig", keep_clean=True)


@pytest.fixture(scope="session")
def free_run(make_synthetic_run):
    return make_synthetic_run(contact=False)
