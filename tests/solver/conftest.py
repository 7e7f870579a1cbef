from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rubgen.arrays import FloatArray
from rubgen.contact.geometry import periodic_derivative
from rubgen.machine import SqueezeFilm
from rubgen.machine.support_laws.breathing_spring import BreathingSpring
from rubgen.machine.support_laws.law import SupportLaw
from rubgen.machine.support_laws.loose_spring import LooseSpring
from rubgen.machine.support_laws.whirling_film import WhirlingFilm
from rubgen.reduction.model import CasingSurface, SpinningSystem, TurningForces
from rubgen.reduction.reduced import rigid_shifts
from rubgen.scenario import Operation
from rubgen.units import rev_per_min

Build = Callable[..., SpinningSystem]


def ring_modes(nodes: int, radius: float, mass_per_angle: float, orders: tuple[int, ...]) -> FloatArray:
    """Inextensional ring modes cos n t and sin n t, mass-normalised, (nodes, 2, 2 len(orders))."""
    t = 2 * np.pi * np.arange(nodes) / nodes
    modes = []
    for n in orders:
        for phase in (0.0, np.pi / 2):
            radial, tangential = np.cos(n * t - phase), -np.sin(n * t - phase) / n
            field = np.stack([radial * np.cos(t) - tangential * np.sin(t), radial * np.sin(t) + tangential * np.cos(t)])
            modes.append(field.T / np.sqrt(np.pi * mass_per_angle * (1 + 1 / n**2)))
    return np.stack(modes, axis=-1)


def ring_rotations(modes: FloatArray, radius: float) -> FloatArray:
    """Rotation (u_t - u_r') / r of a thin ring's sections, (nodes, modes)."""
    t = 2 * np.pi * np.arange(len(modes)) / len(modes)
    e_r = np.stack([np.cos(t), np.sin(t)], axis=1)
    radial = np.einsum("ic,icm->im", e_r, modes)
    tangential = np.einsum("ic,icm->im", np.stack([-e_r[:, 1], e_r[:, 0]], axis=1), modes)
    return (tangential - periodic_derivative(radial)) / radius


def build_small_system(
    speed: float = 400.0,
    lobes: int = 2,
    ovality: float = 2e-3,
    clearance: float = 1e-4,
    unbalance: float = 4e-3,
    turned_nodes: int = 0,
    casing_damping: float = 0.1,
    lateral_damping: float = 0.1,
    blades: int = 6,
    uneven_blade: float = 0.0,
) -> SpinningSystem:
    """Point masses on springs at a disk on springs, in a ring of the orders 1 to 3, all exact by hand.

    Blade 0 is stiffer by the share `uneven_blade`.
    """
    radius, tip_mass, disk_mass = 0.2, 0.05, 8.0
    springs = np.array([4e6, 1.5e6, 1.5e6])
    lateral = 6e6
    angles = 2 * np.pi * np.arange(blades) / blades
    m = 3 * blades + 2
    M, C, K = np.zeros((3, m, m))
    drag = 2 * lateral_damping * np.sqrt(lateral * (disk_mass + blades * tip_mass))
    for k, angle in enumerate(angles):
        tip, axes = slice(3 * k, 3 * k + 3), np.zeros((3, 2))
        axes[:2] = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
        stretch = np.zeros((3, m))
        stretch[:, tip], stretch[:, m - 2 :] = np.eye(3), -axes
        M[tip, tip] += tip_mass * np.eye(3)
        C[3 * k : 3 * k + 2, 3 * k : 3 * k + 2] += 2 * speed * tip_mass * np.array([[0, -1], [1, 0]])
        K[tip, tip] -= speed**2 * tip_mass * np.diag([1, 1, 0])
        K += stretch.T @ np.diag(springs * (1 + uneven_blade * (k == 0))) @ stretch
        C += stretch.T @ np.diag(2 * 0.01 * np.sqrt(springs * tip_mass)) @ stretch
    centre, whirl = slice(m - 2, m), np.array([[0, -1], [1, 0]])
    M[centre, centre] += disk_mass * np.eye(2)
    C[centre, centre] += 2 * speed * disk_mass * whirl + drag * np.eye(2)
    K[centre, centre] += (lateral - speed**2 * disk_mass) * np.eye(2) + drag * speed * whirl
    static = np.zeros((blades, 3))
    static[:, 0] = speed**2 * tip_mass * radius / (springs[0] - speed**2 * tip_mass)
    nodes, orders, mass = 36, (1, 2, 3), 1.5 / (2 * np.pi)
    modes = ring_modes(nodes, radius, mass, orders)
    rotations = ring_rotations(modes, radius)
    turn = 2 * np.pi * turned_nodes / nodes
    turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    modes = np.einsum("ab,nbm->nam", turned, np.roll(modes, turned_nodes, axis=0))
    rotations = np.roll(rotations, turned_nodes, axis=0)
    omega = 2 * np.pi * np.repeat([120.0, 210.0, 390.0], 2)
    c = len(omega)
    zero = np.zeros((m, c))
    force = np.zeros(m + c)
    force[m - 2] = unbalance * speed**2
    return SpinningSystem(
        speed=speed,
        M=np.block([[M, zero], [zero.T, np.eye(c)]]),
        C=np.block([[C, zero], [zero.T, np.diag(2 * casing_damping * omega)]]),
        K=np.block([[K, zero], [zero.T, np.diag(omega**2)]]),
        force=force,
        n_blades=blades,
        n_casing=c,
        tip_radius=radius,
        blade_angles=angles,
        tip_static=static,
        surface=CasingSurface(
            mean_radius=radius + clearance + ovality / 2,
            amplitude=np.array([-ovality / 2]),
            order=np.array([float(lobes)]),
            phase=np.array([turn]),
        ),
        casing_modes=modes,
        casing_rotations=rotations,
        half_thickness=3e-3,
        lateral_stiffness=lateral,
        lateral_damping=drag,
    )


@pytest.fixture(scope="session")
def small_system() -> Build:
    return build_small_system


FILM = SqueezeFilm(radius_m=0.05, length_m=0.03, clearance_m=5e-4, viscosity_pa_s=0.05)  # C_0 = 1,700 N s/m
TURNING = {
    "gravity": {"gravity": 9.81},
    "springs": {"stiffness": 6e5},
    "dampers": {"stiffness": -4e5, "damping": 150.0},
    "film": {"film": FILM},
    "loads": {"loads": 90.0},
    "loose": {"laws": (LooseSpring(lost_n_per_m=4e6, gap_m=2e-5, direction_rad=1.1),)},
    "crack": {"gravity": 9.81, "laws": (BreathingSpring(lost_n_per_m=1e6, direction_rad=0.4),)},
    "whirl": {"laws": (WhirlingFilm(swirl_n_per_m=1e6, soft_n_per_m=5e6, scale_m=2e-4),)},
    "all": {"stiffness": 6e5, "damping": 150.0, "film": FILM, "gravity": 9.81, "loads": 20.0},
}


def build_turning(
    system: SpinningSystem,
    stiffness: float = 0.0,
    damping: float = 0.0,
    film: SqueezeFilm | None = None,
    gravity: float = 0.0,
    loads: float = 0.0,
    laws: tuple[SupportLaw, ...] = (),
) -> SpinningSystem:
    """The small system with uneven supports, a film, other laws, its weight, and loads of turning orders 1 to 4."""
    weight = np.zeros((len(system.M), 2))
    start = system.casing_start
    weight[:start] = gravity * system.M[:start, :start] @ rigid_shifts(system.n_blades, start)
    form = np.random.default_rng(8).normal(size=(5, 4)).view(np.complex128)
    form[0] = 0.0
    forces = TurningForces(
        stiffness=stiffness,
        damping=damping,
        laws=((film,) if film else ()) + laws,
        weight=weight if gravity else None,
        loads=loads * form if loads else None,
    )
    return replace(system, turning=forces)


@pytest.fixture(scope="session")
def turning() -> Build:
    """Turning forces for a system: one of `TURNING` by its name, and changes to it."""
    return lambda system, case, **changes: build_turning(system, **(TURNING[case] | changes))


def build_operation(
    system: SpinningSystem, record_turns: int = 100, steps_per_turn: int = 256, settle_turns: int | str = "auto"
) -> Operation:
    return Operation(
        speed_rpm=rev_per_min(system.speed),
        record_turns=record_turns,
        steps_per_turn=steps_per_turn,
        settle_turns=settle_turns,
    )


@pytest.fixture(scope="session")
def operation() -> Callable[..., Operation]:
    return build_operation
