"""The columns of `runs.parquet` and of the data files: names, types, units, meaning, in their fixed order."""

from __future__ import annotations

from dataclasses import dataclass

from rubgen.errors import UserError
from rubgen.labels.harmonics import FRACTIONS
from rubgen.labels.labels import Motion
from rubgen.scenario.vary import PARAMETERS
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.sensor import SampledSensor
from rubgen.sensors.sensor_set import SensorSet
from rubgen.taps import CasingAcceleration, Tap, TipTiming


@dataclass(frozen=True)
class Column:
    """One column; what a failed run does not have is `nullable`.

    `kind` is text, flag, integer, integers (list), number, numbers (list of float64) or signal (list of float32).
    """

    name: str
    kind: str
    unit: str
    meaning: str
    nullable: bool = False


def _identity() -> list[Column]:
    return [
        Column("run_id", "text", "", "name of the run and of its MCAP and .rrd file"),
        Column("machine_id", "text", "", "hash of the machine before [vary]; splits never share one"),
        Column("split", "text", "", "split of the data set"),
        Column("seed", "integer", "", "seed of the recipe; with the number of the run it makes the run again"),
        Column("status", "text", "", "ok, or why the run failed"),
        Column("reason", "text", "", "where and by how much a run failed; empty for ok"),
    ]


def _parameters() -> list[Column]:
    kinds = {True: "integer", False: "number"}
    return [Column(entry.key, kinds[entry.whole], entry.unit, entry.meaning) for entry in PARAMETERS]


def _operation() -> list[Column]:
    return [
        Column("steps_per_turn", "integer", "", "steps of the integration in one turn"),
        Column("settle_turns", "integer", "", "turns before the record"),
        Column("record_turns", "integer", "", "turns from which the labels come"),
        Column("sample_rate_hz", "number", "Hz", "samples a second of every channel"),
    ]


def _label(name: str, kind: str, unit: str, meaning: str) -> Column:
    return Column(name, kind, unit, meaning, nullable=True)


def _labels() -> list[Column]:
    return [
        _label("rub", "flag", "", "a blade touched the casing within the record"),
        _label("contact_duty", "number", "1", "share of the time in which any blade touches"),
        _label("contact_impulse_per_turn_n_s", "number", "N s", "mean normal impulse a turn, all blades"),
        _label("blades_touched", "integer", "", "number of blades that touched"),
        _label("contact_zones", "integer", "", "number of separate contact zones on the casing"),
        _label("contact_zone_centres_rad", "numbers", "rad", "polar angle of each zone"),
        _label("contact_zone_widths_rad", "numbers", "rad", "angular width of each zone"),
        _label("contact_zones_symmetric", "flag", "", "zones equal and evenly spread; null without contact"),
        *_amounts(),
        _label("motion_blisk", "text", "", "static, period-1, period-k, quasi-periodic, undecided or chaotic"),
        _label("motion_casing", "text", "", "the same of the casing"),
        _label("motion", "text", "", "the less regular of the two"),
        _label("period_blisk", "integer", "turns", "turns after which the blisk repeats; null where it does not"),
        _label("period_casing", "integer", "turns", "the same of the casing"),
        _label("period", "integer", "turns", "least common multiple of the two; null where there is none"),
        _label("motion_confidence", "number", "1", "how sure the class is, 0 to 1; 0 where undecided"),
        _label("motion_symmetric", "flag", "", "q(t + T/N) = q(t) for N lobes; null unless period-1 in contact"),
        _label("motion_intermittent", "flag", "", "the motion switches between regular and irregular"),
        _label("motion_segment_starts_s", "numbers", "s", "starts of its stretches, from the record's start"),
        _label("motion_segment_periods", "integers", "turns", "period of each stretch, 0 where irregular"),
        _label("tip_chatter", "flag", "", "tips do not repeat, disk centre and casing do"),
        _label("stray_blisk", "number", "1", "how far the blisk's section strays from repeating, over its motion"),
        _label("stray_casing", "number", "1", "the same of the casing; null where it rests"),
        _label("zero_one_k", "number", "1", "K of the 0-1 test: near 1 for chaos, near 0 for regular motion"),
        _label("has_2fr", "flag", "", "order 2 stands out of the casing acceleration at 0 degrees"),
        _label("orders_present", "integers", "", "the k up to 20 that stand out of that acceleration, as for has_2fr"),
        _label("lyapunov_per_turn", "number", "1/turn", "largest Lyapunov exponent; null where switched off"),
        _label("lyapunov_per_second", "number", "1/s", "the same by the second"),
        _label("lyapunov_error", "number", "1/turn", "its standard error"),
        _label("lyapunov_convergence", "numbers", "1/turn", "it from 1/10, 2/10, ... of the turns that count"),
        *_course(),
    ]


def _amounts() -> list[Column]:
    return [
        _label("contact_touches", "integer", "", "uninterrupted touches of single blades within the record"),
        _label("contact_friction_work_per_turn_j", "number", "J", "mean work of friction a turn, all blades, <= 0"),
        _label("contact_severity", "number", "1", "mean normal force over the blisk's weight"),
        _label("free_penetration_m", "number", "m", "how deep tips would be without contact; null at changing speeds"),
        _label("rub_extent", "text", "", "none, partial or full-annular"),
        _label("blade_touches", "integers", "", "touches of each blade within the record"),
        _label("blade_impulses_per_turn_n_s", "numbers", "N s", "mean normal impulse a turn of each blade"),
        _label("whirl", "text", "", "direction of the disk centre's orbit: forward, backward or mixed"),
        _label("whirl_index", "number", "1", "1 a circle forward, 0 a line, -1 a circle backward"),
    ]


def _course() -> list[Column]:
    classes = ", ".join(f"{number} {motion.value}" for number, motion in enumerate(Motion))
    return [
        _label("onset_speed_rpm", "number", "rev/min", "speed at the first touch; null without or at a steady speed"),
        _label("end_of_rub_speed_rpm", "number", "rev/min", "speed at the end of the last touch"),
        _label("change_times_s", "numbers", "s", "times from the record's start at which labels change; first 0"),
        _label("change_speeds_rpm", "numbers", "rev/min", "speed at each"),
        _label("change_rub", "integers", "", "1 where a rub goes on from there, else 0"),
        _label("change_impulse_per_turn_n_s", "numbers", "N s", "mean normal impulse a turn until the next"),
        _label("change_motion_classes", "integers", "", f"class of motion from there on: {classes}"),
        _label("window_starts_s", "numbers", "s", "starts of windows of 16 turns"),
        _label("window_speeds_rpm", "numbers", "rev/min", "mean speed of each"),
        _label("window_rub", "integers", "", "1 where a blade touches within the window, else 0"),
        _label("window_contact_duty", "numbers", "1", "share of the time in which any blade touches, of each"),
        _label("window_impulse_per_turn_n_s", "numbers", "N s", "mean normal impulse a turn of each"),
    ]


_FRACTIONS = ", ".join(str(fraction) for fraction in FRACTIONS)
FIELDS = tuple(CasingAcceleration(name=f"casing_{part}", angle_deg=0) for part in ("even", "odd"))
"""Parts of the casing's acceleration of even and odd circumferential order: no taps, but with orders like them."""


def _orders(tap: Tap) -> list[Column]:
    name, unit = tap.name, tap.UNIT
    return [
        _label(f"{name}_orders", "numbers", unit, f"peak amplitudes of {name} at k f_r, k = 1..20"),
        _label(f"{name}_even_share", "number", "1", "share of the squares on even k"),
        _label(f"{name}_odd_share", "number", "1", "share of the squares on odd k"),
        _label(f"{name}_dominant_order", "integer", "", "k of the largest amplitude"),
        _label(f"{name}_order_phases_rad", "numbers", "rad", "phases: A cos(k theta + phase), k = 1..20"),
        _label(f"{name}_order_floors", "numbers", unit, "median amplitude around each k"),
        _label(f"{name}_fractional_amplitudes", "numbers", unit, f"the same at f_r times {_FRACTIONS}"),
        _label(f"{name}_blade_passing", "numbers", unit, "at blade passing and two orders on either side, b-2..b+2"),
    ]


def _energy() -> list[Column]:
    return [
        _label("energy_residual", "number", "1", "error of the energy identity, share of all absolute works"),
        _label("normal_loss_j", "number", "J", "energy lost in normal impacts, <= 0"),
        _label("friction_loss_j", "number", "J", "energy lost in friction, <= 0"),
    ]


def _channel(sensor: SampledSensor | OncePerRev) -> tuple[str, str]:
    """Unit and meaning of a channel."""
    if isinstance(sensor, OncePerRev):
        return "1", "one pulse a turn, from theta = 0"
    about = sensor.description
    return sensor.unit, f"{about.quantity} {about.axis}, {about.location}"


def _arrivals(probe: TimingProbe) -> list[Column]:
    name, place = probe.name, f"{probe.angle_deg:g} deg"
    return [
        Column(f"{name}_s", "numbers", "s", f"arrival times of blades at {place} on the casing"),
        Column(f"{name}_blade", "integers", "", "number of the blade of each arrival"),
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


def _ordered_taps(sensors: SensorSet) -> tuple[Tap, ...]:
    """The true signals that have orders."""
    return (*(tap for tap in sensors.taps if not isinstance(tap, TipTiming)), *FIELDS)


def scalar_columns(sensors: SensorSet) -> tuple[Column, ...]:
    """Columns of `runs.parquet` for runs with these sensors: each true signal that one sees has its orders."""
    orders = [column for tap in _ordered_taps(sensors) for column in _orders(tap)]
    return (*_identity(), *_parameters(), *_operation(), *_labels(), *orders, *_energy())


def signal_columns(sensors: SensorSet, *, clean: bool) -> tuple[Column, ...]:
    """Columns that the data files have beside those of `runs.parquet`; `clean` where those channels are kept too.

    Raises UserError where a sensor has the name of another column.
    """
    facts = {each.name: _channel(each) for each in sensors.sensors if isinstance(each, SampledSensor | OncePerRev)}
    columns = [
        Column("signal_start_s", "number", "s", "time of the first sample from the record's start"),
        Column("rotation_angle_rad", "number", "rad", "angle of the blisk at the first sample"),
        Column("once_per_rev_s", "numbers", "s", "arrival times of the once_per_rev pulses"),
    ]
    columns += [Column(name, "signal", *fact) for name, fact in facts.items()]
    columns += _touches()
    columns += [
        Column(
            f"{tap.name}_window_amplitudes",
            "numbers",
            tap.UNIT,
            "amplitudes at k f_r, twenty a window, the last ones",
        )
        for tap in _ordered_taps(sensors)
    ]
    if clean:
        columns += [Column(f"{name}_clean", "signal", unit, f"{text}, clean") for name, (unit, text) in facts.items()]
    columns += [column for probe in sensors.sensors if isinstance(probe, TimingProbe) for column in _arrivals(probe)]
    _check_names(sensors, columns)
    return tuple(columns)


def _check_names(sensors: SensorSet, columns: list[Column]) -> None:
    taken = [column.name for column in (*scalar_columns(sensors), *columns)]
    for name in taken:
        if taken.count(name) > 1:
            raise UserError(f"sensor set {sensors.name}: two columns would be called {name}; rename that sensor")


ORDER_SUFFIXES = tuple(column.name.removeprefix("tap") for column in _orders(Tap(name="tap")))
"""Ends of the names of the columns that each true signal has."""
