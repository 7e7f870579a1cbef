"""A stepper's matrices as functions of a changing speed.

All numbers of the kernels are smooth functions of the speed Omega and linear in its acceleration Omega'. They are
computed exactly at a few Chebyshev speeds, by the same code as for a steady speed, and interpolated between them.
"""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.polynomial import Chebyshev

from rubgen.arrays import FloatArray, frozen
from rubgen.linalg.block_kernels import Product
from rubgen.linalg.blocks import aligned, entry_rows, padded
from rubgen.linalg.lanes_kernels import FIRST
from rubgen.linalg.vector_kernels import LANES
from rubgen.solver.scheme.free_step_kernels import Scheme
from rubgen.solver.scheme.speed_part import SpeedPart

NODES = 12
"""Number of Chebyshev speeds.

C and K are polynomials in Omega, and Omega dt is small in A = M / dt^2 + C / (2 dt). From 3,000 to 12,000 rev/min the
preset's interpolated matrices are exact except for rounding (tests/solver/speed/test_speed_interpolation.py)."""


SUPPORT = ("columns", "compliance", "rows", "tip_columns", "tip_rows", "laws", "loads", "growing")
"""The fields of `Support` that follow the speed: all products with A^-1, and laws and loads of faults."""


def chebyshev_speeds(slowest: float, fastest: float) -> FloatArray:
    """Return NODES speeds in rad/s from the slowest to the fastest, both included, densest at the ends."""
    nodes = -np.cos(np.pi * np.arange(NODES) / (NODES - 1))
    speeds = 0.5 * (slowest + fastest) + 0.5 * (fastest - slowest) * nodes
    speeds[0], speeds[-1] = slowest, fastest
    return np.asarray(speeds)


def lagrange_weights(nodes: FloatArray, at: FloatArray) -> FloatArray:
    """Return the weights (points, nodes) of the polynomial through values at `nodes`, for the points `at` (points,)."""
    others = np.array([np.delete(nodes, j) for j in range(len(nodes))])
    return np.asarray(np.prod((at[:, None, None] - others) / (nodes[:, None] - others), axis=2))


class SpeedInterpolation:
    """Interpolates the speed parts of a model between `speeds` (NODES,), rad/s.

    `part_at(speed, acceleration)` makes them. `acceleration` is the largest |Omega'|, rad/s2. Only numbers that differ
    between the parts are interpolated.
    """

    def __init__(self, part_at: Callable[[float, float], SpeedPart], speeds: FloatArray, acceleration: float) -> None:
        self.speeds = speeds
        parts = [part_at(speed, 0.0) for speed in speeds.tolist()]
        pushed = [part_at(speed, acceleration) for speed in speeds.tolist()] if acceleration else parts
        self.template = _keep_lines([*parts, *pushed])
        self.layout = _layout([*parts, *pushed])
        self.values = np.array([_packed(part, self.layout) for part in parts])
        slopes = np.array([_packed(part, self.layout) for part in pushed]) - self.values
        slopes /= acceleration or 1.0
        self.slopes = [(place, np.ascontiguousarray(slopes[:, place])) for place in _used_places(slopes, self.layout)]
        self.rooms = [np.zeros((0, self.values.shape[1]))] * 2
        self.pushed = self.rooms[0]
        growth = np.array([part.tips.static[0].mean() for part in parts])
        self.growth = Chebyshev.fit(speeds, growth, deg=NODES - 1, domain=[speeds[0], speeds[-1]])

    def at(self, speeds: FloatArray, accelerations: FloatArray) -> Iterator[SpeedPart]:
        """Yield the part at each speed (rad/s) and acceleration (rad/s2), both (any number,).

        The speeds must lie between the first and the last of `self.speeds`. The parts of a call stay valid during the
        next call. The call after that overwrites them: new memory for each call would take longer than the numbers.
        """
        weights, count = lagrange_weights(self.speeds, speeds), len(speeds)
        rows = self._next_room(count)
        np.matmul(weights, self.values, out=rows)
        for place, slopes in self.slopes:
            pushed = self.pushed[:count, : place.stop - place.start]
            rows[:, place] += np.matmul(accelerations[:, None] * weights, slopes, out=pushed)
        rows.flags.writeable = False
        for row in rows:
            yield _unpacked(self.template, row, self.layout)

    def _next_room(self, count: int) -> FloatArray:
        """Return memory for the rows of so many parts, by turns one of two rooms, and let `pushed` have as many."""
        room = self.rooms.pop(0)
        if len(room) < count:
            room = aligned(np.zeros((count, room.shape[1])))
        if len(self.pushed) < count:
            self.pushed = np.zeros_like(room)
        self.rooms.append(room)
        return room[:count]

    def mean_growth(self, speeds: FloatArray) -> FloatArray:
        """Return the tips' mean steady radial growth in m at each speed (any number,)."""
        return np.asarray(self.growth(speeds))


PartLayout = dict[str, tuple[slice, tuple[int, ...]]]


def _arrays(part: SpeedPart) -> dict[str, FloatArray]:
    """Return all that may change with the speed, by name."""
    scheme, energy = part.scheme, part.energy
    return {
        "static": part.tips.static,
        "bound_rows": part.tips.bound_rows,
        "now": scheme.now,
        "before": scheme.before,
        "constant": scheme.constant,
        "inverse": scheme.inverse,
        "tips": part.tip_compliance,
        "casing": part.casing_compliance,
        "damping": energy.damping.entries,
        "circulatory": energy.circulatory.entries,
        "stiffness": energy.K.entries,
        "force": energy.force,
    } | {name: getattr(part.support, name) for name in SUPPORT}


def _layout(parts: list[SpeedPart]) -> PartLayout:
    """Return place and shape of what differs between parts, each array from a multiple of eight on."""
    arrays, start = [_arrays(part) for part in parts], 0
    layout: PartLayout = {}
    for name, first in arrays[0].items():
        if any(not np.array_equal(first, other[name]) for other in arrays):
            layout[name] = slice(start, start + first.size), first.shape
            start += padded(first.size)
    return layout


def _used_places(slopes: FloatArray, layout: PartLayout) -> list[slice]:
    """Return the places of the arrays in `layout` that follow the acceleration; neighbours are joined."""
    places: list[slice] = []
    for place, _ in layout.values():
        if not slopes[:, place].any():
            continue
        if places and place.start - places[-1].stop < LANES:
            places[-1] = slice(places[-1].start, place.stop)
        else:
            places.append(place)
    return places


def _packed(part: SpeedPart, layout: PartLayout) -> FloatArray:
    row = np.zeros(padded(max((place.stop for place, _ in layout.values()), default=0)))
    arrays = _arrays(part)
    for name, (place, _) in layout.items():
        row[place] = arrays[name].ravel()
    return row


def _unpacked(template: SpeedPart, row: FloatArray, layout: PartLayout) -> SpeedPart:
    new = _arrays(template) | {name: row[place].reshape(shape) for name, (place, shape) in layout.items()}
    scheme, energy = template.scheme, template.energy
    return SpeedPart(
        template.tips._replace(static=new["static"], bound_rows=new["bound_rows"]),
        Scheme(scheme.lines, new["now"], new["before"], new["constant"], new["inverse"]),
        new["tips"],
        new["casing"],
        template.support._replace(
            columns=new["columns"],
            compliance=new["compliance"],
            rows=new["rows"],
            tip_columns=new["tip_columns"],
            tip_rows=new["tip_rows"],
            laws=_with_places(template.support.laws, new["laws"]),
            loads=new["loads"],
            growing=new["growing"],
        ),
        energy._replace(
            damping=Product(energy.damping.lines, new["damping"]),
            circulatory=Product(energy.circulatory.lines, new["circulatory"]),
            K=Product(energy.K.lines, new["stiffness"]),
            force=new["force"],
        ),
    )


def _with_places(laws: FloatArray, numbers: FloatArray) -> FloatArray:
    """Return the numbers of laws with the places of `laws`, whole numbers; a read-only array, as all of a part."""
    rows = np.hstack([laws[:, :1], numbers[:, 1:]])
    rows.flags.writeable = False
    return rows


def _keep_lines(parts: list[SpeedPart]) -> SpeedPart:
    """Return the first part, its circulatory stiffness without the lines that are zero in all parts."""
    energy = parts[0].energy
    used = zip(energy.circulatory.lines[:, FIRST], entry_rows(energy.circulatory.lines), strict=True)
    kept = [any(part.energy.circulatory.entries[first : first + rows].any() for part in parts) for first, rows in used]
    lines = np.ascontiguousarray(energy.circulatory.lines[np.array(kept, dtype=bool)])
    circulatory = Product(lines, energy.circulatory.entries)
    return frozen(parts[0]._replace(energy=energy._replace(circulatory=circulatory)))
