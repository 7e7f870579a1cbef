"""Where on the casing the blades touch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.solver.response import ContactEvents

BINS = 720
"""Bins of half a degree round the casing."""
GAP = np.deg2rad(10.0)
"""Touched arcs with less than this between them are one zone."""
SPECK = 0.02
"""The lightest bins that together hold this share of the impulse are left out, and so is a zone below this share."""
SPACING_TOLERANCE = np.deg2rad(3.0)
WIDTH_TOLERANCE = np.deg2rad(3.0)
IMPULSE_TOLERANCE = 0.05
"""Symmetric: spacings within 3 deg of 2 pi / N, widths within 3 deg, impulses of zones in turns within 5 %, rms."""
PHASES = 64


@dataclass(frozen=True, kw_only=True)
class ContactZones:
    """Arcs of the casing that are touched, by rising centre; `symmetric` is None without contact. Angles in rad.

    `shares` are those of the record's impulse; `imbalance` is that of `turn_imbalance`.
    """

    centres: tuple[float, ...]
    widths: tuple[float, ...]
    shares: tuple[float, ...]
    imbalance: float
    symmetric: bool | None


def contact_zones(events: ContactEvents, *, steps_per_turn: int) -> ContactZones:
    """The contact zones of a record.

    A zone is a connected arc of the impulse histogram: arcs are separated by gaps of more than 10 deg; specks, 2 % of
    the impulse, do not count. Its centre is the mean angle by impulse, its width the arc from its first to its last
    bin. A circle without such a gap is one zone of width 2 pi. Zones are symmetric when their widths and spacings are
    equal and so are their impulses in each turn: over many turns even a chaotic rub has equal means.
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
    """Impulse in each of BINS bins of casing angle from 0, in N s; its sum is the impulse of all events.

    Each event is spread evenly over the angle that the blade swept while it pushed, steps dt Omega, about its mean.
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
    """Sum over i of slope_i * max(edge - start_i, 0) at every edge; starts lie between the first and the last edge."""
    bins = np.minimum(start.astype(np.int64), edges.size - 2)
    begun = np.bincount(bins, weights=slope, minlength=edges.size - 1)
    within = np.bincount(bins, weights=slope * (bins + 1 - start), minlength=edges.size - 1)
    before = np.concatenate([[0.0], np.cumsum(begun)[:-1]])
    return np.concatenate([[0.0], np.cumsum(before + within)])


def _without_lightest(density: FloatArray) -> FloatArray:
    """The histogram without its lightest bins, which together hold the share SPECK at most."""
    rising = np.argsort(density, kind="stable")
    light = np.cumsum(density[rising]) <= SPECK * density.sum()
    kept = density.copy()
    kept[rising[light]] = 0.0
    return kept


def touched_arcs(touched: np.typing.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First bin and number of bins of each arc, gaps up to GAP closed; (0, BINS) for a circle without a gap."""
    bins = np.flatnonzero(touched)
    to_next = np.diff(bins, append=bins[0] + touched.size)
    ends = np.flatnonzero(to_next - 1 > GAP / (2 * np.pi) * touched.size)
    if ends.size == 0:
        return [(0, touched.size)]
    starts = np.roll(ends, 1) + 1
    firsts = bins[starts % bins.size]
    return [(int(f), int((bins[e] - f) % touched.size) + 1) for f, e in zip(firsts, ends, strict=True)]


def _zone(share: FloatArray, first: int, count: int) -> tuple[float, float, float]:
    """Centre, width and share of impulse of the arc of `count` bins from `first`."""
    bins = (first + np.arange(count)) % BINS
    angle = 2 * np.pi * (bins + 0.5) / BINS
    centre = np.angle(np.sum(share[bins] * np.exp(1j * angle)))
    return float(np.mod(centre, 2 * np.pi)), 2 * np.pi * count / BINS, float(share[bins].sum())


def turn_imbalance(events: ContactEvents, centres: FloatArray, steps_per_turn: int) -> float:
    """Rms of the impulse that a zone gets in a turn, less its mean over all zones and turns, over that mean.

    Symmetric motion, q(t + T/N) = q(t), gives every zone the same in every turn, so this is 0.
    An event belongs to the zone whose centre is nearest. Turns are cut where there is least contact, so that no touch
    of a periodic rub falls now into one turn, now into the next; the cut first and last turn are left out.
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
    """Whether N >= 2 zones have equal widths and spacings; a single zone only if it is the whole circle."""
    if len(centres) == 1:
        return bool(widths[0] >= 2 * np.pi - 1e-9)
    spacing = np.diff(centres, append=centres[0] + 2 * np.pi)
    even = np.abs(spacing - 2 * np.pi / len(centres)).max() <= SPACING_TOLERANCE
    return bool(even and np.ptp(widths) <= WIDTH_TOLERANCE)
