"""Draw the figures of `rubgen figure`, by name: of a machine, of a run, or of a whole data set."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure

from rubgen.brief import counted, in_shell
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.reading.replaying import find_replay
from rubgen.errors import NoPictureError, UserError
from rubgen.machine import load_machine
from rubgen.machine.load import file_named
from rubgen.machine.problems import nearest
from rubgen.measurement.front_end import noise_level
from rubgen.reduction import ReducedModel, reduce
from rubgen.scenario import Reduction
from rubgen.scenario.vary import KEYS
from rubgen.viz import figures
from rubgen.viz.derived import order_map
from rubgen.viz.figures.data_set import axis_text, scale_of, varied_keys
from rubgen.viz.figures.style import head
from rubgen.viz.replay import Replay

DEFAULT_MACHINE = "zeng2019"
CHANNEL = "proximity_x"
MOST_RPM, MOST_HZ = 1e6, 1e6
SHOWN_UNIT = {"m": (1e6, "µm"), "m/s2": (1.0, "m/s²")}


@dataclass(frozen=True, kw_only=True)
class Choice:
    """The user's choice of what a figure shows: run, parameter of a sweep, channel, ranges, modes.

    `where` is a condition on the columns of `runs.parquet` that chooses the run. Ranges are texts LOW:HIGH, of the
    speed in rev/min and of the frequency in Hz. None is the default of the figure.
    """

    run_id: str | None = None
    where: str | None = None
    parameter: str | None = None
    channel: str | None = None
    speeds_rpm: str | None = None
    frequencies_hz: str | None = None
    modes: str | None = None


OPTIONS = {
    "run_id": "run",
    "where": "--where",
    "parameter": "--over",
    "channel": "--channel",
    "speeds_rpm": "--speeds-rpm",
    "frequencies_hz": "--frequencies-hz",
    "modes": "--modes",
}
"""Names of the fields of a choice on the command line, for messages."""
Range = tuple[float, float]
Make = Callable[[Path | None, Choice], Figure]


def make_figure(name: str, source: Path | None, choice: Choice) -> Figure:
    """Draw the figure called `name`, one of FIGURES.

    - source: name or TOML of a machine, directory of a data set, or an MCAP file, as the figure needs. None is the
      machine zeng2019 for a figure of a machine.
    - choice: what the figure shows of the source.

    Raises UserError for an unknown figure, a source that does not fit, an option that the figure does not use, and
    missing signals.
    """
    if name not in FIGURES:
        raise UserError(f"figure {name!r}: {nearest(name, list(FIGURES))}")
    try:
        return FIGURES[name](source, choice)
    except NoPictureError as error:
        raise UserError(f"figure {name}: {error}") from None


def _of_machine(draw: Callable[[ReducedModel, Choice], Figure], *options: str) -> Make:
    def make(source: Path | None, choice: Choice) -> Figure:
        _refuse_others(choice, options)
        name = str(source or DEFAULT_MACHINE)
        with file_named(name):
            model = reduce(load_machine(name), Reduction())
        return draw(model, choice)

    return make


def _of_run(draw: Callable[[Replay, Choice], Figure], *options: str) -> Make:
    def make(source: Path | None, choice: Choice) -> Figure:
        _refuse_others(choice, ("run_id", "where", *options))
        return draw(find_replay(_needed(source), choice.run_id, choice.where).replay, choice)

    return make


def _of_set(draw: Callable[[DataSet, Choice], Figure], *options: str) -> Make:
    def make(source: Path | None, choice: Choice) -> Figure:
        _refuse_others(choice, options)
        directory = _needed(source)
        data = DataSet(directory)
        if data.ok.empty:
            raise UserError(f"{directory}: no run is good; see `rubgen info {in_shell(directory)}`")
        return draw(data, choice)

    return make


def _refuse_others(choice: Choice, used: tuple[str, ...]) -> None:
    """Raise UserError for an option that the figure would ignore."""
    for option, name in OPTIONS.items():
        value = getattr(choice, option)
        if value is not None and option not in used:
            raise UserError(f"{name} {value}: this figure has no such option; leave it out")


def _range(choice: Choice, field: str, highest: float) -> Range | None:
    """Read the range LOW:HIGH of a field of the choice; None where it has none."""
    text = getattr(choice, field)
    if text is None:
        return None
    try:
        low, high = map(float, text.split(":"))
    except ValueError:
        low = high = math.nan
    if not 0 <= low < high <= highest:
        raise UserError(
            f"{OPTIONS[field]} {text}: give LOW:HIGH with 0 <= LOW < HIGH <= {highest:g}, such as 6000:12000"
        )
    return low, high


def _speeds(choice: Choice) -> Range | None:
    return _range(choice, "speeds_rpm", MOST_RPM)


def _frequencies(choice: Choice) -> Range | None:
    return _range(choice, "frequencies_hz", MOST_HZ)


def _needed(source: Path | None) -> Path:
    if source is None:
        raise UserError("this figure needs a source; give the directory of a data set, or for one run an MCAP file")
    return source


def _waveform(replay: Replay, choice: Choice) -> Figure:
    return figures.waveform_orders(replay, _channel(choice, "casing_acc_0", replay.recording.channels))


def _channel(choice: Choice, usual: str, recorded: Iterable[str]) -> str:
    """Return the requested channel; else the usual one, or the first of a sensor set without it."""
    names = list(recorded)
    return choice.channel or (usual if usual in names else names[0])


def _bifurcation(data: DataSet, choice: Choice) -> Figure:
    """Draw the channel at each pulse less the mean of each run: k points for period k, for any size of the orbit."""
    key, name = _parameter(data, choice), choice.channel or _without_noise(data, _channel(choice, CHANNEL, data.units))
    unit = data.units.get(name, "")
    scale, unit = SHOWN_UNIT.get(unit, (1.0, unit))
    values, sections, motions = [], [], []
    for run_id, samples, pulses in data.each_channel(name):
        row = data.row(run_id)
        values.append(row[key] * scale_of(key))
        section = scale * np.interp(pulses, np.arange(samples.size) / row["sample_rate_hz"], samples)
        sections.append(section - section.mean())
        motions.append(row["motion"])
    what = "Disk centre $x$" if name.removesuffix("_clean") == CHANNEL else name
    y = f"{what} once a turn about its mean, {unit}"
    noise = scale * _noise(data, name, samples.size)
    figure = figures.bifurcation(np.array(values), sections, motions, x=axis_text(key), y=y, noise=noise)
    return _headed(figure, data, key)


def _noise(data: DataSet, channel: str, samples: int) -> float:
    """Return the rms of a channel's noise in its unit, over that many samples; 0 for a channel without noise."""
    sensing = data.manifest.identity.recorded().sensing
    levels = {each.name: noise_level(each, samples, sensing.sample_rate_hz) for each in sensing.set.sampled}
    return sensing.noise * levels.get(channel, 0.0)


def _cascade(data: DataSet, choice: Choice) -> Figure:
    """Draw order spectra of the channel over the parameter."""
    key, name = _parameter(data, choice), _channel(choice, "casing_acc_0", data.units)
    values, spectra, orders = [], [], np.zeros(0)
    for run_id, samples, pulses in data.each_channel(name):
        row = data.row(run_id)
        found = order_map(samples, row["sample_rate_hz"], pulses)
        if found.amplitude.size:
            values.append(row[key] * scale_of(key))
            spectra.append(found.amplitude.mean(axis=0))
            orders = found.order
    if len({spectrum.size for spectrum in spectra}) != 1:
        raise NoPictureError("signals of 17 turns or more are needed; raise signal_seconds")
    unit = data.units.get(name, "").replace("m/s2", "m/s²")
    figure = figures.spectrum_cascade(np.array(values), orders, np.array(spectra), y=axis_text(key), unit=unit)
    return _headed(figure, data, key, f"; {name}")


def _exponent(data: DataSet, choice: Choice) -> Figure:
    """Draw the column `lyapunov_per_turn` with its error over the parameter."""
    key, good = _parameter(data, choice), data.ok
    known = good[good["lyapunov_per_turn"].notna()]
    if known.empty:
        raise NoPictureError("no run has an exponent; generate with lyapunov = true under [labels]")
    figure = figures.exponent_sweep(
        known[key].to_numpy(dtype=float) * scale_of(key),
        known["lyapunov_per_turn"].to_numpy(dtype=float),
        known["lyapunov_error"].fillna(0.0).to_numpy(dtype=float),
        known["motion"].astype(str).tolist(),
        x=axis_text(key),
    )
    return _headed(figure, data, key)


def _overview(data: DataSet, _choice: Choice) -> Figure:
    figure = figures.dataset_overview(data.runs)
    head(figure, _title(data))
    return figure


def _title(data: DataSet) -> str:
    """Write the set, its number of good runs, and its machine or their number."""
    names = list(dict.fromkeys(each["name"] for each in data.manifest.identity.machines))
    machines = names[0] if len(names) == 1 else f"{len(names)} machines"
    return f"{data.manifest.name}: {counted(len(data.ok), 'run')} of {machines}"


def _headed(figure: Figure, data: DataSet, key: str, more: str = "") -> Figure:
    """Write the set, its machine and its number of runs above a figure, and mark a set that is no sweep of `key`."""
    others = [each for each in varied_keys(data.runs) if each != key]
    warning = f"No sweep: {', '.join(others)} {'vary' if len(others) > 1 else 'varies'} too" if others else ""
    head(figure, f"{_title(data)}{more}", fill(warning, 110))
    return figure


def _parameter(data: DataSet, choice: Choice) -> str:
    varied = varied_keys(data.runs)
    if choice.parameter is None:
        return varied[0] if varied else "speed_rpm"
    if choice.parameter not in varied:
        raise UserError(f"--over {choice.parameter}: {_why_not_over(choice.parameter, varied)}")
    return choice.parameter


def _why_not_over(name: str, varied: list[str]) -> str:
    if not varied:
        return "no parameter varies in this set; leave --over out"
    if name in KEYS:
        return f"does not vary in this set; give one of {', '.join(varied)}"
    return f"unknown parameter; {nearest(name, varied)}"


def _without_noise(data: DataSet, channel: str) -> str:
    """Return the channel without noise where the set has it."""
    clean = f"{channel}_clean"
    return clean if clean in data.units else channel


FIGURES: dict[str, Make] = {
    "campbell": _of_machine(
        lambda model, choice: figures.campbell(model, _speeds(choice), _frequencies(choice)),
        "speeds_rpm", "frequencies_hz",
    ),
    "critical": _of_machine(lambda model, choice: figures.critical_map(model, _speeds(choice)), "speeds_rpm"),
    "unbalance": _of_machine(lambda model, choice: figures.unbalance_response(model, _speeds(choice)), "speeds_rpm"),
    "modes": _of_machine(lambda model, choice: figures.mode_shapes(model, choice.modes), "modes"),
    "orbit": _of_run(lambda replay, _choice: figures.orbit_section(replay)),
    "contact": _of_run(lambda replay, _choice: figures.contact_distribution(replay)),
    "waveform": _of_run(_waveform, "channel"),
    "waterfall": _of_run(lambda replay, choice: figures.waterfall(replay, _speeds(choice)), "speeds_rpm"),
    "bode": _of_run(lambda replay, choice: figures.bode(replay, _speeds(choice)), "speeds_rpm"),
    "bifurcation": _of_set(_bifurcation, "parameter", "channel"),
    "cascade": _of_set(_cascade, "parameter", "channel"),
    "exponent": _of_set(_exponent, "parameter"),
    "overview": _of_set(_overview),
}  # fmt: skip
"""Every figure of the command line: a new one is one entry."""
