"""The command `rubgen modes`: size and natural frequencies of a machine."""

from rubgen.cli.printing import print_json, print_pairs, say
from rubgen.machine import load_machine
from rubgen.machine.load import file_named
from rubgen.machine.published import BLISK_HZ, CASING_HZ, blisk_deviation, casing_deviation
from rubgen.reduction import reduce
from rubgen.scenario import Reduction

PUBLISHED_MACHINE = "zeng2019"
SHOWN_BLISK_MODES = 42


def modes_command(machine: str, *, as_json: bool) -> int:
    """Reduce the machine, a preset's name or a TOML, and print its size, critical speed and frequencies at rest.

    The preset zeng2019 is compared with the published frequencies. Returns the exit code 0.
    """
    loaded = load_machine(machine)
    with file_named(machine):
        model = reduce(loaded, Reduction())
    blisk, casing = model.blisk_frequencies_hz().tolist(), model.casing_frequencies_hz.tolist()
    result: dict[str, object] = {
        "machine": loaded.name,
        "full_dof": model.full_dof,
        "reduced_dof": model.reduced_dof,
        "critical_speed_rpm": float(model.critical_speed_rpm),
        "blisk_hz": blisk,
        "casing_hz": casing,
    }
    compared = machine == PUBLISHED_MACHINE
    if compared:
        result |= {"blisk_deviation": blisk_deviation(blisk), "casing_deviation": casing_deviation(casing)}
    if as_json:
        print_json(result)
        return 0
    print_pairs({name: value for name, value in result.items() if not isinstance(value, list | dict)})
    _table("blisk", blisk[:SHOWN_BLISK_MODES], BLISK_HZ if compared else {})
    _table("casing", casing, dict(enumerate(CASING_HZ, start=1)) if compared else {})
    return 0


def _table(title: str, frequencies: list[float], published: dict[int, float]) -> None:
    say("")
    say(f"{title:<8}{'Hz':>10}{'published':>12}{'deviation':>12}" if published else f"{title:<8}{'Hz':>10}")
    for mode, hz in enumerate(frequencies, start=1):
        if not published:
            say(f"{mode:<8}{hz:>10.3f}")
        elif mode in published:
            say(f"{mode:<8}{hz:>10.3f}{published[mode]:>12.2f}{100 * (hz / published[mode] - 1):>+11.3f}%")
