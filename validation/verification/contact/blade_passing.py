"""Lines of a rub at the blade passing frequency in the acceleration of the casing, with side bands f_r apart.

The casing stands off the centre, so every blade of the preset touches in one zone, once a turn and not alike, as the
unbalance turns with the blades. Casing accelerations of a rotor rig show the number of blades times f_r, and lines f_r
apart around it (Journal of Vibroengineering, 2015, extrica.com/article/16128). Where the recorded force has a line, the
casing's own eleven modes say the acceleration there: sum of phi_j(sensor) phi_j(zone) (-w^2) / (w_j^2 - w^2 + 2 i zeta
w_j w) times the force, in one place. A blade goes 7 degrees while it touches, and all touches cover 10: at the ends of
it modes of five waves have 91 % of their displacement in the middle. In the mean it is less, so 6 % are allowed, and
3 % for the line in the middle. The noise of the sensor is 1 % of the lowest line. Between whole orders there is nothing
but noise.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import rubgen
from rubgen.arrays import ComplexArray, FloatArray
from rubgen.pipeline import Run
from rubgen.reduction import reduce
from validation.verification.row import Row, relative, within

TITLE = "Blade passing in the acceleration of the casing"
SENSOR, SENSOR_DEG = "casing_acc_180", 180
BLADES = 36
BESIDE = (-2, -1, 0, 1, 2)
RUB = {
    "speed_rpm": 9000.0, "free_penetration_m": 2e-5, "ovality_m": 0.0, "unbalance_kg_m": 1e-4,
    "fault": "casing-off-centre", "offset_m": 3e-4, "lyapunov": False, "signal_seconds": 0.4,
}  # fmt: skip
"""A light rub of all blades at the polar angle 180 degrees."""


def rows() -> Iterator[Row]:
    """The line of blade passing, two side bands on either side, and what is between the lines."""
    run = rubgen.simulate(rubgen.make_scenario("zeng2019", **RUB))  # type: ignore[arg-type]
    orders = BLADES + np.array(BESIDE, dtype=np.float64)
    force, felt = lines(run, "contact_force", orders), np.abs(lines(run, SENSOR, orders))
    expected = np.abs(force * accelerance(run, orders))
    for beside, exact, found in zip(BESIDE, expected, felt, strict=True):
        name = f"order {BLADES}{beside:+d}" if beside else f"order {BLADES}, blade passing"
        share = 0.06 if beside else 0.03
        yield relative(f"all blades rub: casing acceleration at {name}, m/s2", "force and modes", exact, found, share)
    between = np.abs(lines(run, SENSOR, orders + 0.5)).max()
    quantity = "all blades rub: the largest line at half orders beside over that of blade passing"
    yield within(quantity, "nothing at half orders", 0.0, between / felt[2], 0.01)


def lines(run: Run, name: str, orders: FloatArray) -> ComplexArray:
    """Return the complex amplitudes (orders,) of a channel over the whole turns of the recording."""
    if run.recording is None:
        raise ValueError(f"the run has no recording: {run.response.reason}")
    rate, turn_hz = run.recording.sample_rate_hz, run.scenario.operation.rotation_frequency_hz
    values = run.recording.channels[name].values.astype(np.float64)
    count = round(np.floor(values.size * turn_hz / rate) * rate / turn_hz)
    angle = 2 * np.pi * turn_hz / rate * np.arange(count)
    centred = values[:count] - values[:count].mean()
    return np.asarray(2 * np.exp(-1j * np.outer(orders, angle)) @ centred / count)


def accelerance(run: Run, orders: FloatArray) -> ComplexArray:
    """Return acceleration at the sensor over the radial force in the zone, 1/kg (orders,), of the casing's modes."""
    machine, events = run.scenario.machine, run.response.events
    casing = reduce(machine, run.scenario.reduction).casing
    nodes = len(casing.modes_xy)
    zone = float(np.average(events.angle, weights=events.impulse))
    places = np.array([np.deg2rad(SENSOR_DEG), zone]) * nodes / (2 * np.pi)
    at_sensor, at_zone = (radial(casing.modes_xy, float(place)) for place in places)
    w, w_j = 2 * np.pi * run.scenario.operation.rotation_frequency_hz * orders, 2 * np.pi * casing.frequencies_hz
    below = w_j**2 - w[:, None] ** 2 + 2j * machine.damping.casing * w_j * w[:, None]
    return np.asarray(-(w**2) * ((at_sensor * at_zone) / below).sum(axis=1))


def radial(modes: FloatArray, node: float) -> FloatArray:
    """Return the radial displacement (modes,) at a place in nodes from 0, linear between two nodes."""
    angle = 2 * np.pi * np.arange(len(modes)) / len(modes)
    shapes = np.cos(angle)[:, None] * modes[:, 0] + np.sin(angle)[:, None] * modes[:, 1]
    first = int(node) % len(modes)
    share = node - int(node)
    return np.asarray((1 - share) * shapes[first] + share * shapes[(first + 1) % len(modes)])
