"""A rigid rotor on a shaft with a breathing crack, under its weight.

The crack takes a share of the shaft's stiffness along its own direction while that direction points down (Mayes,
Davies 1984). To first order in the share the sag delta = m g / k alone opens and closes it: the force share k delta
f(theta) (e . sag) e has a forward part of order 2, share k delta / 4. At half the critical speed it meets the
resonance, and the circle has the radius share delta / (8 zeta). For a crack that is not small, the equations in
inertial axes, which are linear where the weight dominates (Gasch 1993), are integrated apart (scipy, DOP853): forced
lines, and the multipliers of one turn, whose largest tells the decay or, near the critical speed of a hardly damped
rotor, the growth. The scheme's steps make a transition that is (omega dt)^2 / 12 off.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import solve_ivp

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.machine.support_laws.breathing_spring import BreathingSpring
from rubgen.reduction import SpinningSystem, TurningForces
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import slowest_decay
from rubgen.units import rev_per_min
from validation.verification.rotors.rigid_rotor import rigid_rotor, weight_of
from validation.verification.row import Row, relative, within

TITLE = "Breathing crack"
MASS, REST, RATIO, UNBALANCE, GRAVITY = 100.0, 200.0, 0.05, 2e-3, 9.81
STIFFNESS, SAG = MASS * REST**2, GRAVITY / REST**2
SMALL, LARGE, DIRECTION = 1e-4, 0.3, 0.6
UNSTABLE_RATIO = 0.002
ORDERS = (1, 2, 3)


def rotor(speed: float, share: float, unbalance: float, ratio: float = RATIO) -> SpinningSystem:
    """The rotor at `speed` (rad/s); the open crack takes `share` of the stiffness; `ratio` of damping."""
    law = BreathingSpring(lost_n_per_m=share * STIFFNESS, direction_rad=DIRECTION)
    forces = TurningForces(laws=(law,), weight=weight_of(MASS, GRAVITY))
    damping = 2 * ratio * MASS * REST
    return rigid_rotor(speed, mass=MASS, stiffness=STIFFNESS, damping=damping, unbalance=unbalance, forces=forces)


def circles(system: SpinningSystem) -> dict[int, complex]:
    """Circles of X + i Y by order, forward positive, from the harmonic balance."""
    centre = slice(system.centre, system.centre + 2)
    harmonics = rub_free_motion(system).harmonics[:, centre]
    forward, backward = harmonics @ np.array([1, 1j]) / 2, harmonics.conj() @ np.array([1, 1j]) / 2
    turned = {number: complex(forward[number]) for number in range(1, len(harmonics))}
    turned |= {-number: complex(backward[number]) for number in range(1, len(harmonics))}
    return {number + 1: value for number, value in (turned | {0: 2 * complex(forward[0])}).items()}


def slope(t: float, state: FloatArray, speed: float, share: float, ratio: float, *, forced: float) -> list[float]:
    """Slopes of x, y, x', y' in inertial axes; with `forced` 0 without weight and unbalance."""
    x, y, v_x, v_y = state
    angle = speed * t + DIRECTION
    e_x, e_y = np.cos(angle), np.sin(angle)
    opened = share * REST**2 * (1 - e_y) / 2 * (x * e_x + y * e_y)
    push = forced * UNBALANCE * speed**2 / MASS
    return [
        v_x,
        v_y,
        push * np.cos(speed * t) - 2 * ratio * REST * v_x - REST**2 * x + opened * e_x,
        push * np.sin(speed * t) - 2 * ratio * REST * v_y - REST**2 * y + opened * e_y - forced * GRAVITY,
    ]


def lines_apart(speed: float) -> dict[int, complex]:
    """Circles of X + i Y by order of the large crack, from the independent integration."""
    turn, turns, places = 2 * np.pi / speed, 120, 256
    times = turn * (turns + np.arange(places) / places)
    found = solve_ivp(
        lambda t, state: slope(t, state, speed, LARGE, RATIO, forced=1.0), (0, times[-1]), np.zeros(4), method="DOP853",
        rtol=1e-10, atol=1e-14, t_eval=times,
    )  # fmt: skip
    spectrum = np.fft.fft(found.y[0] + 1j * found.y[1]) / places
    return {order: complex(spectrum[order]) for order in range(-4, 5)}


def multipliers(speed: float, ratio: float) -> ComplexArray:
    """Multipliers of one turn with the large crack, from the independent integration."""
    turn, columns = 2 * np.pi / speed, []
    for start in np.eye(4):
        found = solve_ivp(
            lambda t, state: slope(t, state, speed, LARGE, ratio, forced=0.0), (0, turn), start, method="DOP853",
            rtol=1e-11, atol=1e-14,
        )  # fmt: skip
        columns.append(found.y[:, -1])
    return np.linalg.eigvals(np.array(columns).T).astype(np.complex128)


def rows() -> Iterator[Row]:
    """Order 2 at half the critical speed, lines of a large crack, decay and growth, a run."""
    small = circles(rotor(REST / 2, SMALL, unbalance=0.0))
    quantity, source = "breathing crack: order 2 at half the critical speed, m", "share delta / (8 zeta), first order"
    yield relative(quantity, source, SMALL * SAG / (8 * RATIO), abs(small[2]), 20 * SMALL)
    speed = REST / 2
    found, expected = circles(rotor(speed, LARGE, UNBALANCE)), lines_apart(speed)
    source = "two oscillators, integrated apart"
    for order in (*ORDERS, -1):
        quantity = f"breathing crack of {LARGE:g} k: circle of order {order}, m"
        yield relative(quantity, source, abs(expected[order]), abs(found[order]), 1e-6)
    for ratio, at in ((RATIO, 0.7), (UNSTABLE_RATIO, 0.94)):
        speed = at * REST
        decay = -np.log(np.abs(multipliers(speed, ratio)).max()) * speed / (2 * np.pi)
        quantity = f"breathing crack at {at:g} omega_0, zeta = {ratio:g}: slowest decay, 1/s"
        yield relative(
            quantity,
            "multipliers of the same, integrated apart",
            decay,
            slowest_decay(rotor(speed, LARGE, UNBALANCE, ratio)),
            1e-3,
        )
    yield from run()


def run() -> Iterator[Row]:
    """A run keeps the motion in which it starts, and its energy identity."""
    speed = REST / 2
    system = rotor(speed, LARGE, UNBALANCE)
    operation = Operation(speed_rpm=rev_per_min(speed), settle_turns=20, record_turns=40, steps_per_turn=1024)
    response = integrate(system, operation, ContactLaw())
    y = response.taps["blisk_y"][-1024:]
    expected = lines_apart(speed)
    found = 2 / y.size * abs(np.fft.fft(y)[2])
    quantity, source = "breathing crack, run: amplitude of Y at 2 f_r, m", "two oscillators, integrated apart"
    yield relative(quantity, source, abs(expected[2] - expected[-2].conjugate()), found, 1e-3)
    yield within("breathing crack: residual of the energy identity", "0", 0.0, response.energy.residual, 1e-11)
