"""A Jeffcott rotor in an oil film that turns with it.

With z = x + i y at rest, m z'' + c z' + [k - q (soft + i c lambda Omega)] z = U Omega^2 e^(i Omega t) and q = 1 / (1 +
|z|^2 / scale^2). Near the centre q is 1, and the free whirl grows where lambda Omega exceeds omega_f = sqrt((k - soft)
/ m): the threshold of Muszynska (1986). Without unbalance the whirl ends on a circle of radius a at the speed omega,
with c omega = c lambda Omega q(a) and m omega^2 = k - soft q(a). For soft = 0 that is whip: omega is the critical speed
sqrt(k / m) at every Omega, and a = scale sqrt(Omega / Omega_threshold - 1). With a soft film it is whirl: omega follows
the speed, and nears the critical speed far above. The growth rate near the centre is a root of the quadratic equation.
With unbalance both equations are integrated apart (scipy, DOP853). The error of the scheme is (omega dt)^2 / 12 at the
frequencies of the turning frame, with 512 steps a turn.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.labels.labels import Motion
from rubgen.labels.motion.classify import motion
from rubgen.machine.support_laws.whirling_film import WhirlingFilm
from rubgen.reduction import SpinningSystem, TurningForces
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.integrate import integrate
from rubgen.solver.response import Response
from rubgen.solver.scheme.stepper import Stepper
from rubgen.units import rev_per_min
from validation.verification.rotors.rigid_rotor import rigid_rotor
from validation.verification.row import Row, relative, within

TITLE = "Oil whirl"
MASS, REST, RATIO, SWIRL, SCALE = 100.0, 200.0, 0.05, 0.47, 2e-4
STIFFNESS, DAMPING = MASS * REST**2, 2 * RATIO * MASS * REST
SOFT, STEPS = 0.9, 512
UNBALANCE = 2e-3


def rotor(speed: float, soft: float, unbalance: float) -> SpinningSystem:
    """The rotor at `speed` (rad/s); `soft` is the share of stiffness that the film lacks at its centre."""
    law = WhirlingFilm(swirl_n_per_m=DAMPING * SWIRL * speed, soft_n_per_m=soft * STIFFNESS, scale_m=SCALE)
    forces = TurningForces(laws=(law,))
    return rigid_rotor(speed, mass=MASS, stiffness=STIFFNESS, damping=DAMPING, unbalance=unbalance, forces=forces)


def centred(soft: float) -> float:
    """omega_f in rad/s: frequency of the rotor on the centred film."""
    return REST * float(np.sqrt(1 - soft))


def growth(speed: float, soft: float) -> float:
    """Growth rate in 1/s of the free whirl about the centre: the largest real part of the roots."""
    stiffness = complex(STIFFNESS * (1 - soft), -DAMPING * SWIRL * speed)
    return float(np.roots([MASS, DAMPING, stiffness]).real.max())


def found_growth(speed: float, soft: float) -> float:
    """Growth rate in 1/s of a whirl of a thousandth of the scale, from the steps of 30 turns."""
    stepper = Stepper(rotor(speed, soft, 0.0), ContactLaw(), STEPS)
    whirl, centre = centred(soft) - speed, stepper.system.centre  # forward whirl seen from the turning frame
    states = []
    for step in (-1, 0):
        angle = whirl * step * stepper.dt
        q = np.zeros(len(stepper.system.M))
        q[centre : centre + 2] = 1e-3 * SCALE * np.array([np.cos(angle), np.sin(angle)])
        states.append(q)
    stepper.set_coordinates(*states)
    sizes = []
    for _ in range(30):
        stepper.run_turn()
        sizes.append(float(np.hypot(*stepper.coordinates.now[centre : centre + 2])))
    slope: float = np.polyfit(np.arange(20), np.log(sizes[10:]), 1)[0]  # the backward whirl has died after ten turns
    return slope * speed / (2 * np.pi)


def circle(speed: float, soft: float) -> tuple[float, float]:
    """Radius in m and speed in rad/s of the whirl without unbalance, from its two equations."""

    def missing(q: float) -> float:
        return (SWIRL * speed * q) ** 2 - REST**2 * (1 - soft * q)

    q = float(brentq(missing, 1e-9, 1.0))
    return SCALE * float(np.sqrt(1 / q - 1)), SWIRL * speed * q


def run(speed: float, soft: float, unbalance: float) -> Response:
    """The response after 300 turns, over 100 turns."""
    operation = Operation(speed_rpm=rev_per_min(speed), settle_turns=300, record_turns=100, steps_per_turn=STEPS)
    return integrate(rotor(speed, soft, unbalance), operation, ContactLaw())


def whirl(response: Response) -> tuple[float, float]:
    """Rms distance from the axis in m and mean speed of rotation in rad/s over the record."""
    z = response.taps["blisk_x"] + 1j * response.taps["blisk_y"]
    turned = np.unwrap(np.angle(z))
    return float(np.sqrt(np.mean(np.abs(z) ** 2))), float((turned[-1] - turned[0]) / (z.size - 1) / response.dt)


def apart(speed: float, soft: float) -> ComplexArray:
    """X + i Y in m with unbalance, integrated apart from rest, at 64 steps a turn over the same 100 turns."""
    turn = 2 * np.pi / speed
    times = turn * (300 + np.arange(6400) / 64)

    def slope(t: float, state: FloatArray) -> list[float]:
        z, v = complex(state[0], state[1]), complex(state[2], state[3])
        film = complex(soft * STIFFNESS, DAMPING * SWIRL * speed) / (1 + abs(z) ** 2 / SCALE**2)
        push = UNBALANCE * speed**2 * np.exp(1j * speed * t)
        a = (push - DAMPING * v - (STIFFNESS - film) * z) / MASS
        return [v.real, v.imag, a.real, a.imag]

    found = solve_ivp(slope, (0, times[-1]), np.zeros(4), method="DOP853", rtol=1e-8, atol=1e-12, t_eval=times)
    return np.asarray(found.y[0] + 1j * found.y[1])


def rows() -> Iterator[Row]:
    """Growth, threshold, whirl, whip, a forced run."""
    for soft in (0.0, SOFT):
        threshold = centred(soft) / SWIRL
        name = "whip" if soft == 0 else "whirl"
        for ratio in (0.9, 1.3):
            quantity = f"oil {name}: growth at {ratio:g} of the threshold, 1/s"
            source = "root of m s^2 + c s + k - soft - i c lambda Omega"
            yield relative(
                quantity, source, growth(ratio * threshold, soft), found_growth(ratio * threshold, soft), 4e-3
            )
        found = float(
            brentq(lambda speed, soft=soft: found_growth(speed, soft), 0.97 * threshold, 1.03 * threshold, xtol=1e-3)
        )
        yield relative(f"oil {name}: threshold of stability, rad/s", "omega_f / lambda", threshold, found, 1e-3)
    for soft, ratio in ((0.0, 1.5), (0.0, 2.0), (SOFT, 1.2), (SOFT, 2.0), (SOFT, 8.0)):
        speed = ratio * centred(soft) / SWIRL
        radius, omega = circle(speed, soft)
        found_radius, found_omega = whirl(run(speed, soft, unbalance=1e-5))
        name = f"oil {'whip' if soft == 0 else 'whirl'} at {ratio:g} of its threshold"
        yield relative(f"{name}: radius, m", "two equations of the circle", radius, found_radius, 2e-3)
        yield relative(
            f"{name}: frequency over f_r", "two equations of the circle", omega / speed, found_omega / speed, 1e-3
        )
    yield from forced()


def forced() -> Iterator[Row]:
    """A whirl beside the unbalance's: circles of both frequencies, and the class of the motion."""
    speed = 1.3 * centred(SOFT) / SWIRL
    response, expected = run(speed, SOFT, UNBALANCE), apart(speed, SOFT)
    found = (response.taps["blisk_x"] + 1j * response.taps["blisk_y"])[:: STEPS // 64]
    source = "two oscillators, integrated apart"
    for name, at in (("nearest", np.min), ("farthest", np.max)):
        quantity = f"oil whirl with unbalance: {name} place to the axis, m"
        yield relative(quantity, source, float(at(np.abs(expected))), float(at(np.abs(found))), 5e-3)
    label = motion(response).blisk.motion
    yield within(
        "oil whirl with unbalance: is its motion called quasi-periodic?",
        "two frequencies",
        1.0,
        label is Motion.QUASI_PERIODIC,
        0.0,
    )
    yield within("oil whirl: residual of the energy identity", "0", 0.0, response.energy.residual, 1e-11)
