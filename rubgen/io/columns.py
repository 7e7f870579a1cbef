"""The columns of `runs.parquet` and of the data files, in their fixed order: name, role, type, unit, meaning."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from enum import StrEnum

from rubgen.errors import UserError
from rubgen.labels.entries import Label
from rubgen.labels.registry import ENERGY_LABELS, LABELS, TAP_LABELS, WINDOW_LABELS
from rubgen.machine.faults.registry import FAULTS
from rubgen.scenario.machines.keys import MachineKey, own_keys
from rubgen.scenario.surroundings import SURROUNDINGS
from rubgen.scenario.vary import PARAMETERS
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.sensor import SampledSensor
from rubgen.sensors.sensor_set import SensorSet
from rubgen.taps import CasingAcceleration, ContactForce, ContactTorque, Tap, TipTiming


class Role(StrEnum):
    """What a column is for."""

    ID = "id"
    """Names a run, its machine or its split; never to be learned from."""
    TIME = "time"
    """Says when samples were taken."""
    INPUT = "input"
    """Recorded by a sensor: what a model may see."""
    TARGET = "target"
    """An answer that a model may learn."""
    PARAMETER = "parameter"
    """A value of machine, operation, surroundings or simulation. A plant does not know most of them."""
    TRUTH = "truth"
    """Comes from the true motion, which no sensor shows."""
    DIAGNOSTIC = "diagnostic"
    """Says how good the simulation or a label is."""


DIAGNOSTICS = frozenset(x.name for x in (*LABELS, *ENERGY_LABELS) if x.role == "diagnostic")
"""Names of the labels that say how good the simulation or another label is."""
UNMEASURABLE = (ContactForce, ContactTorque)
"""Taps that no probe measures: a channel of them is truth, not input."""

DRAWING = ("twins", "balance", "merged")
"""Tables of a recipe on which runs are drawn, and "merged" for a merged set. They have columns of their own."""
IN_RUNS_ALONE = ("twins", "merged")
"""Those whose columns only `runs.parquet` has. Beside the signals, the name of a partner would tell of a twin, which
never rubs where the clearance is what changes."""


@dataclass(frozen=True)
class Column:
    """One column of a table."""

    name: str
    kind: str
    """text, texts (list), flag, class (integer of a word), integer, integers (list), number, numbers (list of float64)
    or signal (list of float32)."""
    unit: str
    meaning: str
    nullable: bool = False
    """Whether a failed run has null."""
    words: type[StrEnum] | None = None
    """The words whose numbers (`class_numbers`) it has."""
    role: Role = Role.TRUTH


def _identity() -> list[Column]:
    return [
        Column("run_id", "text", "", "name of the run and of its MCAP and .rrd file", role=Role.ID),
        Column("machine_id", "text", "", "hash of the machine before [vary]; splits never share one", role=Role.ID),
        Column("split", "text", "", "split of the data set", role=Role.ID),
        Column(
            "seed",
            "integer",
            "",
            "seed of the recipe; with the number of the run it makes the run again",
            role=Role.ID,
        ),
        Column("status", "text", "", "ok, or why the run failed", role=Role.DIAGNOSTIC),
        Column("reason", "text", "", "where and by how much a run failed; empty for ok", role=Role.DIAGNOSTIC),
    ]


def _parameters() -> list[Column]:
    kinds = {True: "integer", False: "number"}
    return [
        Column(entry.key, kinds[entry.whole], entry.unit, entry.meaning, role=Role.PARAMETER) for entry in PARAMETERS
    ]


def _operation() -> list[Column]:
    return [
        Column("steps_per_turn", "integer", "", "steps of the integration in one turn", role=Role.PARAMETER),
        Column("settle_turns", "integer", "", "turns before the record", role=Role.PARAMETER),
        Column("record_turns", "integer", "", "turns from which the labels come", role=Role.PARAMETER),
        Column("sample_rate_hz", "number", "Hz", "samples a second of every channel", role=Role.TIME),
    ]


def label_columns(labels: Iterable[Label] = LABELS) -> list[Column]:
    """Return one column for each of the labels."""
    return [
        Column(
            x.name,
            "class" if x.words and x.kind == "text" else x.kind,
            x.unit,
            x.meaning,
            nullable=True,
            words=x.words,
            role=Role(x.role),
        )
        for x in labels
    ]


FIELDS = tuple(CasingAcceleration(name=f"casing_{part}", angle_deg=0) for part in ("even", "odd"))
"""Parts of the casing's acceleration with even and odd circumferential order. They are no taps, but have labels too."""


def tap_columns(name: str, unit: str) -> list[Column]:
    """Return the columns of the labels of the tap (true signal) `name`, such as its amplitudes at orders.

    `unit` is the unit of the tap.
    """
    return [
        Column(f"{name}_{x.ending}", x.kind, unit if x.unit is None else x.unit, x.meaning.format(tap=name), True)
        for x in TAP_LABELS
    ]


def _energy() -> list[Column]:
    return [Column(x.name, "number", x.unit, x.meaning, True, role=Role(x.role)) for x in ENERGY_LABELS]


def _channel(sensor: SampledSensor | OncePerRev) -> Column:
    """Return the column of a recorded channel."""
    if isinstance(sensor, OncePerRev):
        return Column(sensor.name, "signal", "1", "one pulse a turn, from theta = 0", role=Role.INPUT)
    about = sensor.description
    role = Role.TRUTH if isinstance(sensor.tap, UNMEASURABLE) else Role.INPUT
    meaning = f"{about.quantity} {about.axis}, {about.location}"
    return Column(sensor.name, "signal", sensor.unit, meaning, role=role)


def _arrivals(probe: TimingProbe) -> list[Column]:
    name, place = probe.name, f"{probe.angle_deg:g} deg"
    return [
        Column(f"{name}_s", "numbers", "s", f"arrival times of blades at {place} on the casing", role=Role.INPUT),
        Column(f"{name}_blade", "integers", "", "number of the blade of each arrival", role=Role.INPUT),
        Column(f"{name}_true_m", "numbers", "m", "true displacement of that blade's tip along the rotation"),
    ]


def _touches() -> list[Column]:
    return [
        Column("touch_start_s", "numbers", "s", "beginning of each touch of a blade, from the first sample; in order"),
        Column("touch_end_s", "numbers", "s", "its end"),
        Column("touch_blade", "integers", "", "number of the blade"),
        Column("touch_angle_rad", "numbers", "rad", "polar angle on the casing, mean by impulse"),
        Column("touch_impulse_n_s", "numbers", "N s", "normal impulse"),
        Column("touch_friction_work_j", "numbers", "J", "work of friction, <= 0"),
    ]


def _surroundings() -> list[Column]:
    levels = [
        *(Column(each.key, "number", each.unit, each.meaning) for each in SURROUNDINGS),
        Column("tones_order", "numbers", "1", "order of each tone; 0 where its frequency is fixed"),
        Column("tones_frequency_hz", "numbers", "Hz", "fixed frequency of each tone; 0 where it has an order"),
        Column("tones_m_per_s2", "numbers", "m/s2", "rms acceleration of each tone on the casing"),
    ]
    return [replace(level, role=Role.PARAMETER) for level in levels]


def _machines(keys: Iterable[MachineKey]) -> list[Column]:
    kinds = {True: "integer", False: "number"}
    columns = [
        Column("machine_number", "integer", "", "number of the virtual machine", role=Role.ID),
        Column(
            "machine_candidate",
            "integer",
            "",
            "its candidate that was used; all candidates before it were refused",
            role=Role.DIAGNOSTIC,
        ),
        *(Column(each.key, kinds[each.whole], each.unit, each.meaning, role=Role.PARAMETER) for each in keys),
    ]
    return columns if keys else []


def _faults(kinds: Iterable[str]) -> list[Column]:
    severities = [FAULTS[kind].SEVERITY for kind in kinds]
    columns = [
        Column("faults", "texts", "", "kinds of fault of the machine in this run"),
        Column("healthy", "flag", "", "neither a fault nor a rub", nullable=True),
        Column("rub_onset_s", "number", "s", "time of the first touch, from the record's start; null without", True),
        *(Column(each.column, "number", each.unit, f"{each.meaning}; 0 without this fault") for each in severities),
    ]
    return [replace(column, role=Role.TARGET) for column in columns] if severities else []


def _twins() -> list[Column]:
    about = "the run that this one differs from in one thing; null for others"
    return [Column("twin_of", "text", "", about, nullable=True, role=Role.ID)]


def _merged() -> list[Column]:
    about = "source of the run in the manifest (first digits of its sha256), and the name of the run there"
    return [Column("merged_from", "text", "", about, role=Role.ID)]


def _balance() -> list[Column]:
    return [
        Column("balance_cell", "text", "", "class of [balance] that the run was drawn for", role=Role.DIAGNOSTIC),
        Column("balance_tries", "integer", "", "number of candidates that were screened for it", role=Role.DIAGNOSTIC),
        Column(
            "balance_seen",
            "integers",
            "",
            "these candidates by class: the classes in order, rub without a class, not possible",
            role=Role.DIAGNOSTIC,
        ),
    ]


def _ordered_taps(sensors: SensorSet) -> tuple[Tap, ...]:
    """Return the true signals with amplitudes at orders: all but passages under a probe, and the parts in FIELDS."""
    return (*(tap for tap in sensors.taps if not isinstance(tap, TipTiming)), *FIELDS)


def scalar_columns(
    sensors: SensorSet,
    *,
    surroundings: bool = False,
    faults: Iterable[str] = (),
    machines: Iterable[MachineKey] = (),
    drawing: Collection[str] = (),
) -> tuple[Column, ...]:
    """Return the columns of `runs.parquet` for runs with the sensor set `sensors`.

    They are identity, parameters, operation, labels, the orders of each tap (true signal) of a sensor, except of timing
    probes, and of the even and odd part of the casing's acceleration, and energies. Further columns are

    - surroundings: the levels of the table `[surroundings]`.
    - faults: labels of the kinds of fault that the runs may have.
    - machines: values of these keys of virtual machines.
    - drawing: names of tables of the recipe: "twins" adds the partner of a twin, "balance" the class for which a run
      was drawn, "merged" the source of a run of a merged set.
    """
    orders = [column for tap in _ordered_taps(sensors) for column in tap_columns(tap.name, tap.UNIT)]
    around = _surroundings() if surroundings else []
    return (
        *_identity(),
        *_parameters(),
        *_operation(),
        *label_columns(),
        *orders,
        *_energy(),
        *around,
        *_faults(faults),
        *_machines(machines),
        *(_twins() if "twins" in drawing else []),
        *(_balance() if "balance" in drawing else []),
        *(_merged() if "merged" in drawing else []),
    )


def every_scalar(sensors: SensorSet) -> tuple[Column, ...]:
    """Return all columns that `runs.parquet` may have, for a recipe with every table."""
    return scalar_columns(sensors, surroundings=True, faults=FAULTS, machines=own_keys(frame=True), drawing=DRAWING)


def signal_columns(sensors: SensorSet, *, clean: bool) -> tuple[Column, ...]:
    """Return the columns that data files have in addition to `runs.parquet`: pulses, channels, touches and so on.

    They are start, angle and pulses, channels, touches, amplitudes by window, and arrivals at timing probes. With
    `clean` the clean channel (without noise) of each channel is included. Raises UserError where a sensor has the name
    of another column.
    """
    channels = [_channel(each) for each in sensors.sensors if isinstance(each, SampledSensor | OncePerRev)]
    seen = Role.INPUT if any(isinstance(each, OncePerRev) for each in sensors.sensors) else Role.TRUTH
    columns = [
        Column("signal_start_s", "number", "s", "time of the first sample from the record's start"),
        Column("rotation_angle_rad", "number", "rad", "angle of the blisk at the first sample"),
        Column("once_per_rev_s", "numbers", "s", "arrival times of the once_per_rev pulses", role=seen),
        *channels,
    ]
    columns += _touches()
    columns += [
        Column(f"{tap.name}_{x.ending}", "numbers", tap.UNIT, x.meaning)
        for tap in _ordered_taps(sensors)
        for x in WINDOW_LABELS
    ]
    if clean:
        columns += [Column(f"{x.name}_clean", "signal", x.unit, f"{x.meaning}, clean") for x in channels]
    columns += [column for probe in sensors.sensors if isinstance(probe, TimingProbe) for column in _arrivals(probe)]
    _check_names(sensors, columns)
    return tuple(columns)


def _check_names(sensors: SensorSet, columns: list[Column]) -> None:
    taken = [column.name for column in (*every_scalar(sensors), *columns)]
    for name in taken:
        if taken.count(name) > 1:
            raise UserError(f"sensor set {sensors.name}: two columns would be called {name}; rename that sensor")
