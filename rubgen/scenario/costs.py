"""Estimate the memory of a machine's reduction and of a run, from their numbers alone, before anything is built."""

import math
from collections.abc import Sequence
from dataclasses import replace

from rubgen.machine import Machine
from rubgen.machine.mesh import disk_nodes
from rubgen.machine.schema_nodes import below, digits
from rubgen.scenario.scenario import Reduction, Scenario

MOST_REDUCTION_BYTES = 4e9
MOST_RUN_BYTES = 2e9
BYTES_A_DOF = 14_000
"""Sparse matrices of the full blisk and their factor, per degree of freedom."""
STEPS_PER_SAMPLE = 2.56
"""Steps per recorded sample that leave room for the anti-alias filter."""
LEAST_TAIL_TURNS = 100
LEAST_TAPS = 11
SURROUNDINGS_ARRAYS, FRAME_ARRAYS = 12, 9
"""Arrays with a value at every step that the surroundings need at a time, and that a frame needs in addition to its
modes."""
GIGA = 1e9
SECONDS_A_STEP = {True: 1.3e-6, False: 4e-6}
"""CPU time of a step of a run that rubs, with its labels and exponent, by whether its speed is steady. Measured in
the recipes speed-sweep and run-up on two virtual cores."""
SECONDS_WITHOUT_RUB = 0.15
"""CPU time of a steady run that never touches: it is made from one turn."""
SECONDS_A_CANDIDATE = 1.2
"""CPU time to reduce a candidate of a virtual machine and to check it. Measured in datasets/machines.toml: 1.7 s on two
virtual cores with other work, where the reduction alone took 1.1 to 1.5 s instead of 0.6 to 0.9 s without it."""
AUTOMATIC_SETTLE_TURNS = 250
"""Usual turns before the record: 155 to 399 in the recipes of rubgen."""
KEPT_SHARE = {"parquet": 0.4, "mcap": 0.8, "rrd": 0.7}
"""Size of a run's file over `stored_bytes`. Sets of four recipes had 0.27 to 0.42 with Parquet, short run-ups 0.71. In
14 runs of five recipes MCAP had 0.48 to 1.08, .rrd 0.32 to 0.89."""
SECONDS_A_STORED_MEGABYTE = {"parquet": 0.02, "mcap": 0.06, "rrd": 0.13}
"""CPU time to write a file, for each megabyte of `stored_bytes`."""


def reduction_bytes(machine: Machine, reduction: Reduction) -> float:
    """Estimate the largest memory of the reduction of a machine, in bytes: 14 kB n + 8 (1.5 n_d m + 4 j^2 + 4 (3 c)^2).

    n are the DoFs of the full blisk, n_d of its disk, m = 6 + 6 blades + disk modes the columns of the disk's basis, j
    the DoFs of disk and blades joined, c the nodes of the casing. Measured growth of memory of `reduce_blisk` in a
    process of its own, with this estimate in brackets: 155 MB in the preset (0.24 GB), 1.6 GB with a disk of 20 x 288
    elements (1.9 GB), 2.1 GB with 240 blades of 10 elements on 10 x 240 (3.5 GB).
    """
    blades = machine.blades
    plate = 6 * disk_nodes(machine.disk)
    full = plate + 6 * blades.count * (blades.elements + 1)
    columns = 6 + 6 * blades.count + reduction.disk_modes
    joined = columns + blades.count * (12 + reduction.blade_modes)
    dense = 1.5 * plate * columns + 4.0 * joined**2 + 4.0 * (3 * machine.casing.nodes) ** 2
    return BYTES_A_DOF * full + 8 * dense


def memory_problem(machine: Machine, reduction: Reduction) -> str | None:
    """Return the problem where the reduction takes more than 4 GB of memory, with the remedy; None where it fits."""
    disk, blades, most = machine.disk, machine.blades, f"at most {MOST_REDUCTION_BYTES / GIGA:g} GB"
    if _fits(machine, reduction):
        return None
    takes = f"takes about {digits(reduction_bytes(machine, reduction) / GIGA)} GB of memory"
    for key in ("blade_modes", "disk_modes"):
        fewer = (replace(reduction, **{key: modes}) for modes in range(getattr(reduction, key)))
        fitting = [getattr(each, key) for each in fewer if _fits(machine, each)]
        if fitting and fitting[-1] >= getattr(Reduction(), key):
            return (
                f"reduction.{key} = {getattr(reduction, key)}: the reduction {takes}, {most}; lower it to {fitting[-1]}"
            )
    size = (
        f"machine {machine.name}: its reduction {takes}, with {blades.count} blades and {disk.radial_elements} x "
        f"{disk.circumferential_elements} elements of the disk; {most}:"
    )
    for radial in range(disk.radial_elements - 1, 0, -1):
        if _fits(replace(machine, disk=replace(disk, radial_elements=radial)), reduction):
            return f"{size} lower disk.radial_elements to {radial}"
    return f"{size} lower disk.circumferential_elements, or the number of blades"


def _fits(machine: Machine, reduction: Reduction) -> bool:
    return reduction_bytes(machine, reduction) <= MOST_REDUCTION_BYTES


def steps_per_turn(scenario: Scenario) -> int:
    """Return the steps of a turn: the operation's `steps_per_turn`, doubled until they are enough for the sensors.

    All steps of a run have one length. The number counts at the highest speed; a slower turn has more steps. Stability
    may double them further, which is known only from the reduced model.
    """
    operation = scenario.operation
    needed = max(1.0, STEPS_PER_SAMPLE * scenario.sensing.fastest_hz * 2 * math.pi / operation.rotation.fastest)
    steps = operation.steps_per_turn
    return steps << max(0, math.ceil(math.log2(needed / steps)))


def bytes_a_turn(scenario: Scenario) -> float:
    """Return the bytes recorded in each turn: one state with its velocity, and order sums where the speed changes."""
    orders = 0 if scenario.operation.profile == "steady" else 20 * 16 * _taps(scenario)
    return 8 * 2 * coordinates(scenario) + orders


def bytes_a_second(scenario: Scenario) -> float:
    """Return the bytes of memory for each second of signal.

    Taps have a value at every step, and count twice because they are joined. Channels count three times where clean
    ones are recorded too, else twice. Surroundings add 12 arrays and two for each tone, a frame 9 and one for each
    mode. The 12, and 17 with eight modes, were measured (tracemalloc) in the set default.
    """
    operation, sensing = scenario.operation, scenario.sensing
    steps = steps_per_turn(scenario) * operation.rotation.fastest / (2 * math.pi)
    around = scenario.surroundings
    added = SURROUNDINGS_ARRAYS + 2 * len(around.tones) if around else 0
    added += FRAME_ARRAYS + len(scenario.frame.modes) if scenario.frame else 0
    samples = (3 if sensing.keep_clean else 2) * sensing.sample_rate_hz
    return 8 * (_taps(scenario) * (2 * steps + samples) + added * steps)


def coordinates(scenario: Scenario) -> int:
    """Return the number of DoFs of the reduced model: three a blade, two of the disk centre, one a mode."""
    modes = scenario.reduction.blisk_modes + scenario.reduction.casing_modes
    return 3 * scenario.machine.blades.count + 2 + modes


def stored_bytes(scenario: Scenario) -> float:
    """Return the bytes of a run's channels and states in a file before compression, with 4 bytes a number."""
    sensing = scenario.sensing
    channels = (2 if sensing.keep_clean else 1) * len(sensing.set.sensors)
    states = 2 * coordinates(scenario) * scenario.operation.recorded_turns
    return 4 * (channels * scenario.signal_seconds * sensing.sample_rate_hz + states)


def run_seconds(scenario: Scenario, *, rubs: bool, formats: Sequence[str] = ()) -> float:
    """Estimate the CPU time in s of a run with its files in `formats`, within a factor of two on a computer of today.

    `rubs` is whether blades touch in the run: a steady run without contact is made from one turn. `formats` are of
    parquet, mcap and rrd.
    """
    operation, megabytes = scenario.operation, stored_bytes(scenario) / 1e6
    writing = sum(SECONDS_A_STORED_MEGABYTE.get(name, 0.0) * megabytes for name in formats)
    steady = operation.profile == "steady"
    if steady and not rubs:
        return SECONDS_WITHOUT_RUB + writing
    settle = AUTOMATIC_SETTLE_TURNS if operation.settle_turns == "auto" else operation.settle_turns
    steps = (settle + operation.recorded_turns) * steps_per_turn(scenario)
    return SECONDS_A_STEP[steady] * steps + writing


def file_bytes(scenario: Scenario, name: str) -> float:
    """Estimate the size in bytes of a run's file, within a factor of two.

    `name` is the format: parquet, mcap or rrd.
    """
    return KEPT_SHARE.get(name, 1.0) * stored_bytes(scenario)


def run_problem(scenario: Scenario) -> str | None:
    """Return the problem where a run takes more than 2 GB of memory, with the remedy; None without a problem.

    Record and signals are checked apart: each may take 2 GB.
    """
    operation = scenario.operation
    turn, second = bytes_a_turn(scenario), bytes_a_second(scenario)
    if operation.recorded_turns * turn > MOST_RUN_BYTES:
        return _too_long(scenario, int(MOST_RUN_BYTES / turn))
    memory = scenario.frame.memory_seconds if scenario.frame else 0.0
    tail = max(scenario.signal_seconds + memory, LEAST_TAIL_TURNS / operation.rotation_frequency_hz)
    if tail * second <= MOST_RUN_BYTES:
        return None
    needed = f"takes about {digits(tail * second / GIGA)} GB of memory, at most {MOST_RUN_BYTES / GIGA:g} GB"
    seconds = MOST_RUN_BYTES / second - memory
    if seconds <= 0:
        before = f"the slowest needs {digits(memory)} s of the record before the signals"
        return f"frame.modes: {before}, {needed}; damp it more"
    return f"output.signal_seconds = {scenario.signal_seconds:g}: {needed}; lower it to {below(seconds)}, or the rate"


def _too_long(scenario: Scenario, most: int) -> str:
    operation = scenario.operation
    needed = f"{operation.recorded_turns:,} turns take more than {MOST_RUN_BYTES / GIGA:g} GB of memory"
    if operation.duration_s is None:
        return f"simulation.record_turns = {operation.record_turns}: {needed}; lower it to {most}"
    seconds = most / operation.recorded_turns * operation.duration_s
    return f"operation.duration_s = {operation.duration_s:g}: {needed}; lower it to {below(seconds)}"


def _taps(scenario: Scenario) -> int:
    return max(LEAST_TAPS, len(scenario.sensing.set.sensors))
