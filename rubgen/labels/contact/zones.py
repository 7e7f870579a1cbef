"""Find where on the casing the blades touch."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.solver.response import ContactEvents

BINS = 720
"""Bins of half a degree round the casing."""
GAP = np.deg2rad(10.0)
"""Arcs with contact are one zone where the gap between them is at most this."""
SPECK = 0.02
"""The lightest bins that together have this share of the impulse are left out, and zones below this share too."""
SPACING_TOLERANCE = np.deg2rad(3.0)
WIDTH_TOLERANCE = np.deg2rad(3.0)
IMPULSE_TOLERANCE = 0.05
"""Zones are symmetric where spacings are within 3 deg of 2 pi / N, widths within 3 deg, and impulses in each turn
within 5 %, rms."""
PHASES = 64


@dataclass(frozen=True, kw_only=True)
class ContactZones:
    """Arcs of the casing with contact, sorted by their centre. Without contact there are none."""

    centres: tuple[float, ...]
    """Mean angle by impulse of each zone, rad."""
    widths: tuple[float, ...]
    """Angular width of each zone, rad."""
    shares: tuple[float, ...]
    """Share of the record's impulse in each zone."""
    imbalance: float
    """How unequal the zones are turn by turn, see `turn_imbalance`."""
    symmetric: bool | None
    """Whether the zones are symmetric; None without contact."""


def contact_zones(events: ContactEvents, *, steps_per_turn: int) -> ContactZones:
    """Find the contact zones of a record: arcs of the casing with impulse, and whether they are symmetric.

    A zone is a connected arc of the impulse histogram. Gaps of more than 10 deg separate zones. The lightest bins, 2 %
    of the impulse in all, are left out first, then zones with less than 2 %. `imbalance` counts their impulse too. A
    zone's centre is its mean angle weighted by impulse. Its width is the arc from its first to its last bin. A circle
    without a gap above 10 deg is one zone of width 2 pi. Zones are symmetric if their widths and spacings are equal
    within 3 deg and their impulses in each turn within 5 % (rms): over many turns even a chaotic rub has equal mean
    impulses. A single zone is symmetric only as the whole circle.

    - events: touches, in steps of equal angle.
    - steps_per_turn: number of such steps in a turn.
    """
    density = impulse_histogram(events, steps_per_turn)
    if density.sum() <= 0:
        return ContactZones(centres=(), widths=(), shares=(), imbalance=0.0, symmetric=None)
    arcs = touched_arcs(_without_lightest(density) > 0)
    zones = [_zone(density / density.sum(), first, count) for first, count in arcs]
    zones = sorted(zone for zone in zones if zone[2] >= SPECK)
    centres, widths, shares = (tuple(zone[i] for zone in zones) for i in range(3))
    imbalance = turn_imbalance(events, np.array(centres), steps_per_turn)
    return ContactZones(
        centres=centres,
        widths=widths,
        shares=shares,
        imbalance=imbalance,
        symmetric=_evenly_placed(centres, widths) and imbalance <= IMPULSE_TOLERANCE,
    )


def impulse_histogram(events: ContactEvents, steps_per_turn: int) -> FloatArray:
    """Distribute the impulse of all touches over BINS bins of casing angle from 0.

    Returns the normal impulse of each bin (BINS,), N s; zeros without touches. The bins add up to the impulse of all
    touches. The impulse of a touch is distributed evenly over the angle that the blade swept during contact, at most a
    whole turn, with the touch's mean angle in the middle. `events` and `steps_per_turn` are as in `contact_zones`.
    """
    sweep = np.minimum(events.steps * (2 * np.pi / steps_per_turn), 2 * np.pi)
    start = np.mod(events.angle - sweep / 2, 2 * np.pi) / (2 * np.pi) * BINS
    end = start + np.maximum(sweep / (2 * np.pi) * BINS, 1e-6)
    density = events.impulse / (end - start)
    edges = np.arange(2 * BINS + 1)
    # The cumulated impulse at every edge is the sum of ramps, each of which starts and ends somewhere inside a bin.
    cumulated = _ramps(start, density, edges) - _ramps(end, density, edges)
    unrolled = np.maximum(np.diff(cumulated), 0.0)
    histogram = unrolled[:BINS] + unrolled[BINS:]
    return np.where(histogram > 1e-12 * histogram.sum(), histogram, 0.0)


def _ramps(start: FloatArray, slope: FloatArray, edges: IntArray) -> FloatArray:
    """Return the sum over i of slope_i * max(edge - start_i, 0) at every edge; starts lie between the outer edges."""
    bins = np.minimum(start.astype(np.int64), edges.size - 2)
    begun = np.bincount(bins, weights=slope, minlength=edges.size - 1)
    within = np.bincount(bins, weights=slope * (bins + 1 - start), minlength=edges.size - 1)
    before = np.concatenate([[0.0], np.cumsum(begun)[:-1]])
    return np.concatenate([[0.0], np.cumsum(before + within)])


def _without_lightest(density: FloatArray) -> FloatArray:
    """Return the histogram without its lightest bins, which together have at most the share SPECK."""
    rising = np.argsort(density, kind="stable")
    light = np.cumsum(density[rising]) <= SPECK * density.sum()
    kept = density.copy()
    kept[rising[light]] = 0.0
    return kept


def touched_arcs(touched: np.typing.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first bin and the number of bins of each arc of True bins in `touched`, on a circle.

    At least one bin must be True. Gaps up to GAP are closed. If no gap is larger, the single arc is (0, number of
    bins).
    """
    bins = np.flatnonzero(touched)
    to_next = np.diff(bins, append=bins[0] + touched.size)
    ends = np.flatnonzero(to_next - 1 > GAP / (2 * np.pi) * touched.size)
    if ends.size == 0:
        return [(0, touched.size)]
    starts = np.roll(ends, 1) + 1
    firsts = bins[starts % bins.size]
    return [(int(f), int((bins[e] - f) % touched.size) + 1) for f, e in zip(firsts, ends, strict=True)]


def _zone(share: FloatArray, first: int, count: int) -> tuple[float, float, float]:
    """Return centre, width and share of impulse of the arc of `count` bins from `first`."""
    bins = (first + np.arange(count)) % BINS
    angle = 2 * np.pi * (bins + 0.5) / BINS
    centre = np.angle(np.sum(share[bins] * np.exp(1j * angle)))
    return float(np.mod(centre, 2 * np.pi)), 2 * np.pi * count / BINS, float(share[bins].sum())


def turn_imbalance(events: ContactEvents, centres: FloatArray, steps_per_turn: int) -> float:
    """Compute how unequal the zones are: standard deviation over mean of the impulses of all zones in all turns.

    It is 0 for symmetric motion, q(t + T/N) = q(t), where all zones have equal impulses in each turn. An event belongs
    to the zone with the nearest centre. A turn begins at the angle of the blisk with the least impulse, so that no
    touch of a periodic rub changes from one turn to the next. The incomplete first and last turn are left out if there
    are more than two turns.

    - events: the touches of the record, at least one.
    - centres (zones,): centres of the zones, rad.
    - steps_per_turn: number of steps in a turn.
    """
    middle = (events.start_step + events.steps / 2) / steps_per_turn
    load, edges = np.histogram(np.mod(middle, 1.0), PHASES, (0.0, 1.0), weights=events.impulse)
    turn = np.floor(middle - edges[np.argmin(load)]).astype(np.int64)
    zone = np.abs(np.angle(np.exp(1j * (events.angle[:, None] - centres)))).argmin(axis=1)
    impulse = np.zeros((turn.max() - turn.min() + 1, centres.size))
    np.add.at(impulse, (turn - turn.min(), zone), events.impulse)
    whole = impulse[1:-1] if impulse.shape[0] > 2 else impulse
    if whole.sum() == 0:
        return 0.0
    return float(whole.std() / whole.mean())


def _evenly_placed(centres: tuple[float, ...], widths: tuple[float, ...]) -> bool:
    """Return whether N >= 2 zones have equal widths and spacings; a single zone only if it is the whole circle."""
    if len(centres) == 1:
        return bool(widths[0] >= 2 * np.pi - 1e-9)
    spacing = np.diff(centres, append=centres[0] + 2 * np.pi)
    even = np.abs(spacing - 2 * np.pi / len(centres)).max() <= SPACING_TOLERANCE
    return bool(even and np.ptp(widths) <= WIDTH_TOLERANCE)
