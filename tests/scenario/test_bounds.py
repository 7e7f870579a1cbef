"""No number of any record is without bounds: what no machine has is refused or warned of, wherever it stands."""

import math
import types
from dataclasses import fields, is_dataclass, replace
from typing import Annotated, ClassVar, Literal, Union, get_args, get_origin, get_type_hints

import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError

from rubgen.errors import UserError
from rubgen.machine import Machine, Mistuning, SqueezeFilm, Unbalance, load_machine
from rubgen.scenario import Liner, Scenario, make_scenario
from rubgen.scenario.checks.feasible import check_feasible
from rubgen.scenario.checks.plausible import implausible
from rubgen.scenario.tables.run import Output, Profile, Sensors, Simulation
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.registry import AnySensor
from rubgen.sensors.sensor_set import SensorSet

HUGE = (1e300, -1e300, math.inf, math.nan)


def records():
    """Every record that a user's file describes."""
    found, todo = [], [Scenario, Machine, SensorSet, Simulation, Profile, Sensors, Output]
    while todo:
        kind = todo.pop()
        if kind in found:
            continue
        found.append(kind)
        hints = get_type_hints(kind, include_extras=True)
        todo += [part for hint in hints.values() for part in parts(hint) if is_dataclass(part)]
    return found


def parts(hint):
    """The types that a type is made of."""
    if get_origin(hint) in (ClassVar, Literal):
        return
    if get_origin(hint) is None or get_origin(hint) is Annotated:
        yield hint if get_origin(hint) is None else get_args(hint)[0]
    for each in get_args(hint):
        if isinstance(each, type) or get_origin(each) is not None:
            yield from parts(each)


def numbers():
    for kind in records():
        names = kind.model_fields if issubclass(kind, BaseModel) else [field.name for field in fields(kind)]
        hints = get_type_hints(kind, include_extras=True)
        for name in names:
            if {float, int} & set(parts(hints[name])):
                yield pytest.param(hints[name], id=f"{kind.__name__}.{name}")


def wrapped(hint, value):
    """A value of the type's form: a number, or lists of it."""
    if get_origin(hint) is Annotated:
        return wrapped(get_args(hint)[0], value)
    if get_origin(hint) in (Union, types.UnionType):
        return wrapped(next(each for each in get_args(hint) if {float, int} & set(parts(each))), value)
    if get_origin(hint) is tuple:
        return [wrapped(each, value) for each in get_args(hint) if each is not Ellipsis]
    return value


@pytest.mark.parametrize("hint", list(numbers()))
def test_no_number_is_without_bounds(hint):
    for value in HUGE:
        with pytest.raises(ValidationError):
            TypeAdapter(hint).validate_python(wrapped(hint, value))


def test_the_walk_sees_all_records():
    names = {kind.__name__ for kind in records()}
    assert {"Material", "Mistuning", "SqueezeFilm", "Damping", "Liner", "Reduction", "RunoutOrder"} <= names
    assert {kind.__name__ for kind in get_args(get_args(AnySensor)[0])} <= names
    assert len(list(numbers())) > 130


MACHINE = load_machine("zeng2019")
FILM = SqueezeFilm(radius_m=0.08, length_m=0.03, clearance_m=2e-4, viscosity_pa_s=0.02)
LINER = Liner(thickness_m=1e-3, wear_m2_per_n=1e-12, width_m=0.03)


def changed(record, place, value):
    name, *rest = place.split(".", 1)
    return replace(record, **{name: changed(getattr(record, name), rest[0], value) if rest else value})


def complaints(**changes):
    """What is said of a scenario with all that a machine may have, and these values; places are written with __."""
    base = make_scenario()
    base = changed(base, "machine.disk_support.squeeze_film", FILM)
    base = changed(base, "machine.blades.mistuning", Mistuning(relative_std=0.02, seed=3))
    scenario = changed(base, "contact.liner", LINER)
    assert list(implausible(scenario)) == []
    for place, value in changes.items():
        scenario = changed(scenario, place.replace("__", "."), value)
    try:
        check_feasible(scenario)
    except UserError as error:
        return [str(error)]
    return list(implausible(scenario))


MISTUNED = {"pattern": [0.6] + 35 * [0.0]}
WRONG = [
    ("machine__damping__blade", 0.999, "damping.blade = 0.999: machines have 0.001 to 0.3; were % meant, 0.00999?"),
    ("machine__damping__lateral", 0.8, "lateral_damping = 0.8: machines have 0.001 to 0.3; were % meant, 0.008?"),
    (
        "machine__blades__mistuning",
        MISTUNED,
        "blades.mistuning.pattern.0 = 0.6: blades of a row differ by a few percent; were % meant, 0.006?",
    ),
    (
        "machine__disk_support__lateral_stiffness_n_per_m",
        100.0,
        "disk_support_stiffness_n_per_m = 100: on it the blisk has a frequency of 0.15 Hz; were N/um meant, 1e+08 N/m?",
    ),
    (
        "machine__disk_support__torsion_stiffness_nm_per_rad",
        1e-3,
        "disk_support.torsion_stiffness_nm_per_rad = 0.001: on it the blisk has a frequency of 0.0026 Hz",
    ),
    (
        "machine__casing__radial_support_stiffness_n_per_m",
        0.05,
        "casing_support_stiffness_n_per_m = 0.05: on it the casing has a frequency of ",
    ),
    (
        "machine__disk_support__squeeze_film__clearance_m",
        60.0,
        "disk_support.squeeze_film.clearance_m = 60: must be below the radius of the journal, 0.08 m; were um meant, 6",
    ),
    (
        "machine__disk_support__squeeze_film__clearance_m",
        0.02,
        "disk_support.squeeze_film.clearance_m = 0.02: 25 % of the radius of the journal; were mm meant, 2e-05 m?",
    ),
    (
        "machine__disk_support__squeeze_film__viscosity_pa_s",
        20.0,
        "disk_support.squeeze_film.viscosity_pa_s = 20: oils have 0.001 to 1; were mPa s meant, 0.02 Pa s?",
    ),
    ("machine__disk_support__squeeze_film__radius_m", 0.3, "disk_support.squeeze_film.radius_m = 0.3: larger than"),
    ("contact__liner__thickness_m", 1.0, "contact.liner.thickness_m = 1: must be below the radius of the casing, 0.40"),
    ("contact__liner__thickness_m", 0.1, "contact.liner.thickness_m = 0.1: 24.7 % of the radius of the casing"),
    ("contact__liner__width_m", 1.0, "contact.liner.width_m = 1: larger than the width of the casing, 0.26662 m"),
    (
        "contact__liner__wear_m2_per_n",
        1e-3,
        "contact.liner.wear_m2_per_n = 0.001: linings wear 1e-14 to 1e-9; were mm3/(N m) meant, 1e-12 m2/N?",
    ),
    ("sensing__noise", 1e5, "noise = 100000: 1 is the noise that each sensor has"),
    ("operation__settle_turns", 10**6, "settle_turns = 1e+06: a run of so many turns takes from minutes to hours"),
    ("operation__record_turns", 10**6, "record_turns = 1e+06: a run of so many turns takes from minutes to hours"),
    ("operation__closing_turns", 10**6, "closing_turns = 1e+06: a run of so many turns takes from minutes to hours"),
    (
        "machine__unbalances",
        [Unbalance(kg_m=1e6, angle_deg=0.0)],
        "unbalances.0.kg_m = 1e+06: would move the centre of mass 8,460 m off the axis, outside of the blisk; were",
    ),
]


@pytest.mark.parametrize(("place", "value", "message"), WRONG)
def test_what_no_machine_has_is_told_in_one_line(place, value, message):
    value = Mistuning(**value) if isinstance(value, dict) else value
    found = complaints(**{place: value})
    assert len(found) == 1
    assert found[0].startswith(message)


SENSORS = [
    ('kind = "blade_tip_timing"\nangle_deg = 0\nclock_hz = 1', "clock_hz of s = 1: it counts 0.000167 times between"),
    ('kind = "once_per_rev"\nclock_hz = 1', "clock_hz of s = 1: it counts 0.006 times between two passages; were MHz"),
    ('kind = "once_per_rev"\njitter_s = 0.5', "jitter_s of s = 0.5: 8,330 % of the time between two passages"),
    ('kind = "blade_tip_timing"\nangle_deg = 0\nmissed = 0.99', "missed of s = 0.99: hardly a blade is seen; were % m"),
    ('kind = "proximity"\nangle_deg = 0\nnoise_rms = 1', "noise_rms of s = 1: more than its whole range, [-0.002, 0.0"),
    ('kind = "proximity"\nangle_deg = 0\nnoise_density = 1', "noise_density of s = 1: more than its whole range"),
    ('kind = "accelerometer"\nangle_deg = 0\noffset = 1e9', "offset of s = 1e+09: more than its whole range, [-50000"),
    ('kind = "torque"\ndrift_per_s = -1e8', "drift_per_s of s = -1e+08: more than its whole range, [-20000, 20000] N"),
    ('kind = "torque"\ndropouts_per_s = 1e6', "dropouts_per_s of s = 1e+06: 100,000 % of the signal is lost"),
    ('kind = "torque"\ngain_error = 5', "gain_error of s = 5: sensors err by a few percent; were % meant, 0.05?"),
    (
        'kind = "proximity"\nangle_deg = 0\nunit = "V"\nsensitivity_v_per_m = 7.874',
        "sensitivity_v_per_m of s = 7.874: proximity probes have 4000 to 20000; were mV/um or V/mm meant, 7874 V/m?",
    ),
    ('kind = "torque"\n[[shaft_runout]]\norder = 1\namplitude_m = 0.01', "shaft_runout.0.amplitude_m = 0.01: 16.7 %"),
    (
        'kind = "torque"\n[[shaft_runout]]\norder = 1\namplitude_m = 10',
        "shaft_runout.0.amplitude_m = 10: must be below the radius of the disk's bore, 0.06 m; were um meant, 1e-05 m?",
    ),
]


@pytest.mark.parametrize(("text", "message"), SENSORS)
def test_a_sensor_that_shows_nothing_is_told_in_one_line(text, message, tmp_path):
    other = '[[sensors]]\nname = "t"\nkind = "torque"\n'
    (tmp_path / "s.toml").write_text(f'name = "s"\n{other}[[sensors]]\nname = "s"\n{text}\n')
    found = complaints(sensing__set=load_sensor_set("s.toml", tmp_path))
    assert len(found) == 1
    assert found[0].startswith(message)
