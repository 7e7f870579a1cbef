"""The windows that models see: the same samples as features and as random convolutions, and what belongs to each."""

import numpy as np

import rubgen
from rubgen.baseline import windows
from rubgen.baseline.windows import windows_of

SAMPLES, RATE = 15872, 25600.0


def test_features_and_convolutions_see_the_same_windows(small_set, monkeypatch):
    """Nine windows, which do not divide the samples: the shorter rest is left out, and no window is lost."""
    monkeypatch.setattr(windows, "WINDOWS", count := 9)
    data = rubgen.open(small_set.directory)
    found = windows_of(small_set.directory, data, seeds=1, workers=1)
    names, size = list(data.ok.index), SAMPLES // count
    assert found.runs.tolist() == np.repeat(names, count).tolist()
    start = np.tile(size / RATE * np.arange(count), len(names))
    np.testing.assert_allclose(found.edges, np.column_stack([start, start + size / RATE]), rtol=1e-12)
    assert found.splits.tolist() == np.repeat(data.ok["split"].to_numpy(dtype=str), count).tolist()
    channels = [sensor.name for sensor in data.sensors.sampled if sensor.name in data.inputs]
    # The last numbers of the convolutions are mean and log10 of the rms of each channel: features have both too.
    levels = found.inputs["rocket 0"][:, -2 * len(channels) :]
    assert len(levels) == len(found.runs) == len(found.inputs["features"])
    for run, name in enumerate(names):
        signals = data.signals(name)
        for number in range(count):
            own = levels[run * count + number]
            cut = np.array([signals[channel][number * size : (number + 1) * size] for channel in channels], dtype=float)
            np.testing.assert_allclose(own[len(channels) :], np.log10(cut.std(axis=1)), atol=1e-3)
    rms = found.inputs["features"][:, 1]
    np.testing.assert_allclose(np.log10(rms), levels[:, len(channels)], atol=1e-3)
