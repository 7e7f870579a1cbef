"""What a file of another format holds of one run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from rubgen.arrays import FloatArray
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.reading.replaying import scenario_of
from rubgen.measurement.channel import Float32Array
from rubgen.reduction import ReducedModel, reduce
from rubgen.sensors.sensor import SampledSensor


@dataclass(frozen=True)
class ExportedChannel:
    """One recorded channel with its sensor."""

    name: str
    unit: str
    values: Float32Array
    sensor: SampledSensor | None
    """None is the pulse of the shaft."""

    @property
    def facts(self) -> dict[str, str | float]:
        """The description of its sensor by name.

        The names are `kind`, `quantity`, `axis`, `location`, `range_min`, `range_max` in the unit of the channel, and
        `angle_deg` if the sensor has an angle. The pulse of the shaft has neither range nor angle.
        """
        if self.sensor is None:
            return {"kind": "once_per_rev", "quantity": "pulse", "axis": "", "location": "shaft"}
        about, (low, high) = self.sensor.description, self.sensor.full_range
        facts: dict[str, str | float] = {
            "kind": str(getattr(self.sensor, "kind", "")),
            "quantity": about.quantity,
            "axis": about.axis,
            "location": about.location,
            "range_min": low,
            "range_max": high,
        }
        angle = getattr(self.sensor, "angle_deg", None)
        return facts if angle is None else facts | {"angle_deg": float(angle)}


@dataclass(frozen=True)
class ExportedRun:
    """One run of a data set, with everything that export formats may write."""

    run_id: str
    split: str
    row: dict[str, Any]
    """Its parameters and labels by column, as plain values; None where one is undefined."""
    sample_rate_hz: float
    channels: tuple[ExportedChannel, ...]
    pulses: FloatArray
    """Times of the pulses in s from the first sample on."""
    model: Callable[[], ReducedModel]
    """Reduces the machine of the run."""

    @property
    def samples(self) -> int:
        """Number of samples of every channel."""
        return self.channels[0].values.size


def exported_runs(data: DataSet, run_ids: Sequence[str], channels: Sequence[str]) -> Iterator[ExportedRun]:
    """Yield the good runs `run_ids` in this order, each with the channels `channels`; one is in memory at a time."""
    sensors = {sensor.name: sensor for sensor in data.sensors.sampled}
    for run_id, signals, pulses in data.recorded(run_ids, channels):
        row = data.row(run_id)
        found = tuple(ExportedChannel(name, data.units[name], signals[name], sensors.get(name)) for name in channels)
        yield ExportedRun(
            run_id, str(row["split"]), row, data.sample_rate_hz, found, pulses, partial(_model, data, run_id)
        )


def _model(data: DataSet, run_id: str) -> ReducedModel:
    scenario = scenario_of(data, run_id)
    return reduce(scenario.machine, scenario.reduction)


def without_nulls(values: list[Any]) -> list[Any]:
    """Replace None in a list by NaN, or by an empty text in a list of texts, for formats without null."""
    blank: Any = "" if any(isinstance(each, str) for each in values) else float("nan")
    return [blank if each is None else each for each in values]
