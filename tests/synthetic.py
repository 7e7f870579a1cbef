"""A synthetic run for tests of files and pictures: made-up signals through the real sensors, no dynamics."""

from dataclasses import replace

import numpy as np

from rubgen.labels.contact.amounts import ContactAmounts, RubExtent
from rubgen.labels.harmonics import FRACTIONS, HIGHEST_ORDER, TapOrders
from rubgen.labels.labels import Labels, Motion
from rubgen.labels.windows import Windows
from rubgen.machine import load_machine
from rubgen.measurement import measure
from rubgen.pipeline import Run
from rubgen.scenario import Operation, Scenario, Sensing
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.sensor_set import SensorSet
from rubgen.solver.response import ContactEvents, EnergyBalance, Response, Status, TipArrivals, Track
from rubgen.taps import (
    CasingAcceleration,
    CentreDisplacement,
    ContactForce,
    ContactTorque,
    DriveTorque,
    RingStrain,
    RootStrain,
    SupportForce,
    TipClearance,
    TipTiming,
)

TURNS, STEPS = 120, 512
BLADES, STATES = 36, 125

SCALES = {
    CentreDisplacement: 1e-4, CasingAcceleration: 300.0, SupportForce: 2e4, ContactForce: 1e3, TipClearance: 1e-3,
    RootStrain: 1e-4, RingStrain: 2e-4, DriveTorque: 100.0, ContactTorque: 100.0,
}  # fmt: skip
"""Sizes of the made signals in the unit of each kind of tap."""


def _taps(
    generator: np.random.Generator, sensors: SensorSet, speed: float, dt: float, contact: bool
) -> dict[str, np.ndarray]:
    time = dt * np.arange(1 - TURNS * STEPS, 1)
    force = 4000.0 * np.maximum(0.0, np.cos(2 * speed * time)) ** 8 if contact else np.zeros_like(time)
    taps = {}
    for tap in sensors.taps:
        if not isinstance(tap, TipTiming):
            first, second = generator.uniform(0, 2 * np.pi, 2)
            wave = np.cos(speed * time + first) + 0.3 * np.cos(3 * speed * time + second)
            taps[tap.name] = SCALES[type(tap)] * (wave + (2.0 if isinstance(tap, TipClearance) else 0.0))
    return taps | {"contact_force": force}


def _arrivals(generator: np.random.Generator, sensors: SensorSet, speed: float, dt: float) -> dict[str, TipArrivals]:
    """Every blade of every turn, early by a made deflection."""
    seen = {}
    for probe in sensors.sensors:
        if isinstance(probe, TimingProbe):
            turn, blade = np.divmod(np.arange(TURNS * BLADES), BLADES)
            deflection = 1e-4 * generator.standard_normal(turn.size)
            place = np.deg2rad(probe.angle_deg) / (2 * np.pi) + (blade + 0.5) / BLADES - deflection / (2 * np.pi * 0.4)
            order = np.argsort(turn + place)
            step = (turn + place)[order] * STEPS
            seen[probe.name] = TipArrivals(blade=BLADES - 1 - blade[order], step=step, displacement=deflection[order])
    return seen


def _events(generator: np.random.Generator, count: int) -> ContactEvents:
    start = np.sort(generator.integers(0, TURNS * STEPS - 40, count))
    return ContactEvents(
        blade=generator.integers(0, BLADES, count),
        start_step=start,
        steps=generator.integers(1, 30, count),
        angle=np.mod(generator.normal(0.0, 0.1, count) + np.pi * generator.integers(0, 2, count), 2 * np.pi),
        impulse=generator.gamma(2.0, 0.05, count),
        friction_loss=-generator.gamma(2.0, 0.01, count),
        normal_loss=-generator.gamma(2.0, 0.01, count),
    )


def _track(generator: np.random.Generator) -> Track:
    """Eight turns of 32 frames in the middle of the signals."""
    step = STEPS * (TURNS - 30) + np.arange(256) * STEPS // 32
    theta, nodes = 2 * np.pi * step / STEPS, 2 * np.pi * np.arange(60) / 60
    phase = generator.uniform(0, 2 * np.pi, STATES)
    modes = [[np.cos(n * nodes) * np.cos(nodes), np.cos(n * nodes) * np.sin(nodes)] for n in range(2, 13)]
    return Track(
        step=step,
        q=2e-4 * np.cos(np.multiply.outer(theta, np.ones(STATES)) + phase),
        tip_growth=np.tile([1e-4, 0.0, 0.0], (1, BLADES, 1)),
        casing_modes=np.transpose(modes, (2, 1, 0)),
    )


def _response(generator: np.random.Generator, scenario: Scenario, contact: bool) -> Response:
    speed = scenario.operation.speed_rad_per_s
    dt = 2 * np.pi / speed / STEPS
    works = dict.fromkeys(EnergyBalance.__dataclass_fields__, 1.0) | {"residual": 1e-13}
    return Response(
        status=Status.OK,
        reason="",
        speed=speed,
        dt=dt,
        steps_per_turn=STEPS,
        settle_turns=100,
        record_turns=TURNS,
        taps=_taps(generator, scenario.sensing.set, speed, dt, contact),
        section_q=1e-4 + 1e-6 * generator.standard_normal((TURNS, STATES)),
        section_v=1e-2 * generator.standard_normal((TURNS, STATES)),
        impulse_per_turn=np.full(TURNS, 1.5 if contact else 0.0),
        contact_steps_per_turn=np.full(TURNS, 64 if contact else 0),
        events=_events(generator, 600 if contact else 0),
        energy=EnergyBalance(**works),
        n_blades=BLADES,
        n_casing=11,
        arrivals=_arrivals(np.random.default_rng(5), scenario.sensing.set, speed, dt),
        track=_track(generator),
    )


def _orders(generator: np.random.Generator) -> TapOrders:
    return TapOrders(
        amplitudes=1.0 + generator.gamma(1.0, 1.0, HIGHEST_ORDER),
        phases=generator.uniform(-np.pi, np.pi, HIGHEST_ORDER),
        floors=np.full(HIGHEST_ORDER, 1e-3),
        fractional=generator.gamma(1.0, 1e-3, len(FRACTIONS)),
        blade_passing=generator.gamma(1.0, 1e-2, 5),
    )


def _amounts(contact: bool) -> ContactAmounts:
    """Fifty touches of every blade that share the impulse of 1.5 N s a turn, or none."""
    count = 50 if contact else 0
    return ContactAmounts(
        touches=count * BLADES,
        friction_work=-0.5 if contact else 0.0,
        blade_touches=np.full(BLADES, count),
        blade_impulses=np.full(BLADES, 1.5 / BLADES if contact else 0.0),
        severity=0.2 if contact else 0.0,
        free_penetration=1e-5 if contact else -1e-4,
        extent=RubExtent.PARTIAL if contact else RubExtent.NONE,
    )


def _labels(generator: np.random.Generator, response: Response, contact: bool) -> Labels:
    orders = {name: _orders(generator) for name in ("blisk_x", "casing_acc_0", "contact_force")}
    if not contact:
        orders["contact_force"] = replace(orders["contact_force"], amplitudes=np.zeros(HIGHEST_ORDER))
    none = np.zeros(0)
    return Labels(
        amounts=_amounts(contact),
        rub=contact,
        contact_duty=0.125 if contact else 0.0,
        impulse_per_turn=1.5 if contact else 0.0,
        blades_touched=BLADES if contact else 0,
        contact_zones=2 if contact else 0,
        contact_zone_centres=(0.0, np.pi) if contact else (),
        contact_zone_widths=(0.3, 0.31) if contact else (),
        contact_zones_symmetric=True if contact else None,
        motion_blisk=Motion.PERIOD_1,
        motion_casing=Motion.PERIOD_K if contact else Motion.STATIC,
        motion=Motion.PERIOD_K if contact else Motion.PERIOD_1,
        period_blisk=1,
        period_casing=3 if contact else None,
        period=3 if contact else 1,
        has_2fr=contact,
        orders=orders,
        orders_present=orders["casing_acc_0"].present if contact else (),
        windows=Windows(start=none, speed=none, impulse=none, duty=none, orders={}, scatter={}),
        response=response,
    )


def make_run(
    *, contact: bool = True, seconds: float = 0.3, keep_clean: bool = False, seed: int = 1, sensors: str = "default"
) -> Run:
    """A run with made-up signals: same arguments, same run."""
    generator = np.random.default_rng(seed)
    scenario = Scenario(
        machine=load_machine("zeng2019"),
        operation=Operation(speed_rpm=10000.0, record_turns=TURNS, steps_per_turn=STEPS),
        sensing=Sensing(keep_clean=keep_clean, set=load_sensor_set(sensors)),
        signal_seconds=seconds,
        seed=seed,
    )
    response = _response(generator, scenario, contact)
    recording = measure(response, scenario.sensing, seconds=seconds, rng=generator, frame=scenario.frame)
    labels = _labels(generator, response, contact)
    return Run(scenario=scenario, response=response, recording=recording, labels=labels)
