"""The command `rubgen modes`: size and natural modes of a machine."""

from dataclasses import asdict

from rubgen.cli.printing import print_json, print_pairs, say
from rubgen.errors import UserError
from rubgen.machine import load_machine
from rubgen.machine.load import file_named
from rubgen.machine.published import BLISK_HZ, CASING_HZ, blisk_deviation, casing_deviation
from rubgen.reduction import ReducedModel, reduce
from rubgen.reduction.modes import Mode, blisk_modes, casing_diameters, critical_speeds_rpm
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s

PUBLISHED_MACHINE = "zeng2019"
SHOWN_BLISK_MODES = 42
HIGHEST_RPM = 60_000.0


def modes_command(machine: str, speed_rpm: float, *, as_json: bool) -> int:
    """Reduce a machine and print its size, critical speed and modes at `speed_rpm`. Returns the exit code 0.

    `machine` is the name of a preset or the path of a TOML file. `as_json` prints JSON, with all modes. Uneven springs
    have a critical speed each, beside that of their mean. At rest the preset zeng2019 is compared with the published
    frequencies. Raises UserError for a speed outside 0 to 60,000 rev/min.
    """
    if not 0 <= speed_rpm <= HIGHEST_RPM:
        raise UserError(f"--speed-rpm {speed_rpm:g}: must be from 0 to {HIGHEST_RPM:,.0f}")
    loaded = load_machine(machine)
    with file_named(machine):
        model = reduce(loaded, Reduction())
    blisk, casing = model.blisk_frequencies_hz().tolist(), model.casing_frequencies_hz.tolist()
    modes, waves = blisk_modes(model, rad_per_s(speed_rpm)), casing_diameters(model)
    result: dict[str, object] = {
        "machine": loaded.name,
        "full_dof": model.full_dof,
        "reduced_dof": model.reduced_dof,
        "critical_speed_rpm": float(model.critical_speed_rpm),
        **_of_each_spring(model),
        "blisk_hz": blisk,
        "casing_hz": casing,
        "speed_rpm": speed_rpm,
        "blisk_modes": [asdict(mode) for mode in modes],
        "casing_nodal_diameters": waves,
    }
    compared = machine == PUBLISHED_MACHINE and speed_rpm == 0
    if compared:
        result |= {"blisk_deviation": blisk_deviation(blisk), "casing_deviation": casing_deviation(casing)}
    if as_json:
        print_json(result)
        return 0
    print_pairs({name: value for name, value in result.items() if not isinstance(value, list | dict)})
    if speed_rpm:
        _at_speed(modes[:SHOWN_BLISK_MODES])
    else:
        words = [f"{mode.family:<10}{mode.nodal_diameters:>4}{_percent(mode):>8} %" for mode in modes]
        _table("blisk", blisk[:SHOWN_BLISK_MODES], words, BLISK_HZ if compared else {})
    damping = 100 * loaded.damping.casing
    words = [f"{'':<10}{wave:>4}{damping:>8.2f} %" for wave in waves]
    _table("casing", casing, words, dict(enumerate(CASING_HZ, start=1)) if compared else {})
    return 0


def _percent(mode: Mode) -> str:
    """Return the damping in percent; rounding of an undamped mode has no sign."""
    return f"{round(100 * mode.damping_ratio, 2) + 0.0:.2f}"


def _of_each_spring(model: ReducedModel) -> dict[str, float]:
    """Return the critical speeds of the springs along X and Y; nothing where the springs are even."""
    speeds = critical_speeds_rpm(model)
    names = ("critical_speed_x_rpm", "critical_speed_y_rpm")
    return dict(zip(names, speeds, strict=True)) if len(speeds) > 1 else {}


def _table(title: str, frequencies: list[float], words: list[str], published: dict[int, float]) -> None:
    say("")
    head = f"{title:<8}{'Hz':>10}  {'family':<10}{'ND':>4}{'damping':>10}"
    say(f"{head}{'published':>12}{'deviation':>12}" if published else head)
    for number, (hz, text) in enumerate(zip(frequencies, words, strict=False), start=1):
        line = f"{number:<8}{hz:>10.3f}  {text}"
        if not published:
            say(line)
        elif number in published:
            say(f"{line}{published[number]:>12.2f}{100 * (hz / published[number] - 1):>+11.3f}%")


def _at_speed(modes: list[Mode]) -> None:
    say("")
    say(f"{'blisk':<8}{'turning Hz':>12}{'inertial Hz':>13}  {'whirl':<10}{'family':<10}{'ND':>4}{'damping':>10}")
    for number, mode in enumerate(modes, start=1):
        say(
            f"{number:<8}{abs(mode.turning_hz):>12.3f}{abs(mode.inertial_hz):>13.3f}  {mode.whirl:<10}{mode.family:<10}"
            f"{mode.nodal_diameters:>4}{_percent(mode):>8} %"
        )
