"""A rigid rotor whose support is loose on one side.

In inertial axes the rotor is two oscillators. X: m x'' + c x' + k x = U Omega^2 cos(Omega t). Y has the weight beside
the unbalance, and beyond the gap the support has lost a part of its stiffness: m y'' + c y' + k y - lost (y - gap)+ =
U Omega^2 sin(Omega t) - m g. Free and undamped, with a gap of 0, Y swings one half period with each stiffness, so its
period is pi / omega_1 + pi / omega_2, whatever the amplitude. The forced motion is integrated apart, by a method of
eighth order in inertial axes (scipy, DOP853), and compared line by line. Which multiple of the turn it repeats after is
counted there too, and by the label of the motion. The error of the scheme is (omega dt)^2 / 12 of the fastest motion
in the turning frame, 1e-5 with 1,024 steps a turn; a line below f_r is more sensitive, and differs by up to 1e-3. Some
speeds have two motions, so both integrations start from the motion of the tight rotor, as every run does.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from rubgen.arrays import FloatArray
from rubgen.labels.motion.classify import motion
from rubgen.machine.support_laws.loose_spring import LooseSpring
from rubgen.reduction import SpinningSystem, TurningForces
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.integrate import integrate
from rubgen.solver.response import Response
from rubgen.solver.scheme.stepper import Stepper
from rubgen.units import rev_per_min
from validation.verification.rotors.rigid_rotor import rigid_rotor, weight_of
from validation.verification.row import Row, relative, within

TITLE = "Loose support"
MASS, REST, RATIO, UNBALANCE, GRAVITY = 100.0, 200.0, 0.05, 0.02, 9.81
STIFFNESS, DAMPING = MASS * REST**2, 2 * RATIO * MASS * REST
CASES = {
    "half order": (0.8, 0.0, 1.8, GRAVITY),
    "third order": (0.9, 0.0, 1.6, 0.0),
    "clipping": (0.8, 3e-5, 0.45, 0.0),
}
"""Lost share of the stiffness, gap in m, speed over the frequency of the tight rotor, gravity in m/s2."""
STEPS, SETTLE, RECORD, SPECTRUM = 1024, 100, 40, 12


def rotor(
    speed: float, lost: float, gap: float, gravity: float, damping: float = DAMPING, unbalance: float = UNBALANCE
) -> SpinningSystem:
    """The rotor at `speed` (rad/s), loose along +Y: `lost` is a share of the stiffness, `gap` in m."""
    law = LooseSpring(lost_n_per_m=lost * STIFFNESS, gap_m=gap, direction_rad=np.pi / 2)
    forces = TurningForces(laws=(law,), weight=weight_of(MASS, gravity) if gravity else None)
    return rigid_rotor(speed, mass=MASS, stiffness=STIFFNESS, damping=damping, unbalance=unbalance, forces=forces)


@cache
def run(case: str) -> Response:
    """The response of a case."""
    lost, gap, ratio, gravity = CASES[case]
    system = rotor(ratio * REST, lost, gap, gravity)
    operation = Operation(
        speed_rpm=rev_per_min(system.speed), settle_turns=SETTLE, record_turns=RECORD, steps_per_turn=STEPS
    )
    return integrate(system, operation, ContactLaw())


@cache
def apart(case: str) -> FloatArray:
    """Y in m at 64 steps a turn over the last turns, integrated apart from the motion of the tight rotor on."""
    lost, gap, ratio, gravity = CASES[case]
    speed = ratio * REST
    turn = 2 * np.pi / speed

    def slope(t: float, state: FloatArray) -> list[float]:
        y, v = state
        beyond = max(y - gap, 0.0)
        force = (
            UNBALANCE * speed**2 * np.sin(speed * t) - MASS * gravity - DAMPING * v - STIFFNESS * (y - lost * beyond)
        )
        return [v, force / MASS]

    tight = -1j * UNBALANCE * speed**2 / complex(STIFFNESS - MASS * speed**2, DAMPING * speed)
    start = [tight.real - MASS * gravity / STIFFNESS, (1j * speed * tight).real]
    times = turn * (SETTLE + RECORD - SPECTRUM + np.arange(64 * SPECTRUM) / 64)
    found = solve_ivp(
        slope, (0, times[-1]), start, method="DOP853", rtol=1e-9, atol=1e-13, t_eval=times, max_step=turn / 24
    )
    return np.asarray(found.y[0])


def lines(y: FloatArray, turns: int) -> dict[float, float]:
    """Amplitudes in m by order of rotation, in steps of 1 / turns, from equal steps over so many turns."""
    amplitudes = 2 / y.size * np.abs(np.fft.rfft(y))
    return {number / turns: float(amplitudes[number]) for number in range(1, 3 * turns + 1)}


def repeats_after(y: FloatArray) -> int:
    """The number of turns after which 64 steps a turn repeat within 0.1 % of their size."""
    return next(n for n in range(1, SPECTRUM // 2 + 1) if np.abs(y[64 * n :] - y[: -64 * n]).max() < 1e-3 * np.ptp(y))


def free_period() -> float:
    """Period in s of the free vibration along Y with 0.75 of the stiffness lost beyond a gap of 0, from the steps."""
    speed, amplitude, steps = 40.0, 1e-4, 8192
    system = rotor(speed, 0.75, 0.0, 0.0, damping=0.0, unbalance=0.0)
    stepper = Stepper(system, ContactLaw(), steps)
    states = []
    for step in (-1, 0):
        angle = 2 * np.pi * step / steps
        q = np.zeros(len(system.M))
        q[system.centre : system.centre + 2] = amplitude * np.array([np.sin(angle), np.cos(angle)])
        states.append(q)
    stepper.set_coordinates(*states)
    stepper.run_turn()
    y = stepper.result.taps[1]
    after = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    crossings = after + y[after] / (y[after] - y[after + 1])
    return float(np.mean(np.diff(crossings))) * stepper.dt


def rows() -> Iterator[Row]:
    """Free period, lines of the spectrum, clipping, period of the motion."""
    expected = np.pi / REST + np.pi / (REST * np.sqrt(0.25))
    yield relative(
        "loose support: period of free vibration, s", "pi / omega_1 + pi / omega_2", expected, free_period(), 1e-4
    )
    source = "two oscillators, integrated apart"
    for case in ("half order", "third order"):
        period = repeats_after(apart(case))
        found, expected_lines = lines(displacement(case), SPECTRUM), lines(apart(case), SPECTRUM)
        for order in (1 / period, 1.0):
            quantity = f"loose support, {case}: amplitude at {order:.3g} f_r, m"
            yield relative(quantity, source, expected_lines[order], found[order], 2e-3)
        label = motion(run(case)).blisk
        yield within(
            f"loose support, {case}: turns after which the motion repeats", source, period, label.period or 0, 0
        )
    for name, peak in (("largest", np.max), ("smallest", np.min)):
        quantity = f"loose support, clipping: {name} Y, m"
        yield relative(quantity, source, float(peak(apart("clipping"))), float(peak(displacement("clipping"))), 1e-3)
    energy = run("half order").energy
    yield within("loose support: residual of the energy identity", "0", 0.0, energy.residual, 1e-11)


def displacement(case: str) -> FloatArray:
    """Y in m over the last turns of a run."""
    return run(case).taps["blisk_y"][-STEPS * SPECTRUM :]
