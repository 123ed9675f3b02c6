"""Rings from lines that people draw: edges twice, gaps and overshoots at corners, lines that cross a piece.

Lines are cut wherever they meet, and the cells between them are put together again. What encloses cells that share an
edge is one ring, so a line from corner to corner divides nothing, and one that leads nowhere is no part of a ring.
"""

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np
import shapely

from planner.geometry.pose import FloatArray
from planner.geometry.ring import corners
from planner.geometry.segment import Segment
from planner.geometry.tolerance import GRID_M, LENGTH_M

_FINER = 0.2
"""The share of a gap that is closed first, so that ends which nearly meet do not go to others further away."""

_PLACES = 9
"""Places along a line at which it is looked at whether it runs along an edge."""

_TOGETHER = 50
"""Segments whose crossings are counted at once: each may cross all others."""

_LONG = 4.0
"""How many gaps long a line is at least that is left out as drawn twice, or whose own ends may meet."""


def enclosing_rings(lines: Sequence[FloatArray], gap_m: float) -> list[FloatArray]:
    """Return the rings that lines make together, each shape (n, 2), its first point not repeated.

    Args:
        lines: the lines, each shape (n, 2), n at least 2 (m).
        gap_m: the largest gap between an end and another line that is closed (m).
    """
    drawn = _once([line.copy() for line in lines if np.ptp(line, axis=0).max() > LENGTH_M], gap_m)
    for gap in (LENGTH_M, _FINER * gap_m, gap_m):
        _close_gaps(drawn, gap)
    noded = shapely.union_all([shapely.LineString(line) for line in drawn], grid_size=GRID_M)
    return _enclosing(shapely.get_parts(shapely.polygonize([noded])))


def are_tangled(lines: Sequence[FloatArray], crossings_max: int) -> bool:
    """Return whether lines, each shape (n, 2), cross more than a number of times, too many to find cells fast."""
    segments = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    strings = shapely.linestrings(segments)
    tree, left = shapely.STRtree(strings), 2 * crossings_max + 3 * len(strings)
    for first in range(0, len(strings), _TOGETHER):
        left -= tree.query(strings[first : first + _TOGETHER], "intersects").shape[1]
        if left < 0:
            return True
    return False


def united_ring(rings: Iterable[FloatArray], gap_m: float) -> FloatArray | None:
    """Return the ring that encloses several that touch each other; None if they do not make one piece.

    Args:
        rings: the rings, each shape (n, 2).
        gap_m: the width of a crack between them that is closed (m).
    """
    polygons = [shapely.make_valid(shapely.Polygon(ring)) for ring in rings]
    whole = shapely.union_all(polygons, grid_size=GRID_M)
    if shapely.get_num_geometries(whole) > 1:
        wide = shapely.buffer(whole, gap_m / 2.0 + LENGTH_M, join_style="mitre")
        whole = shapely.buffer(wide, -gap_m / 2.0 - LENGTH_M, join_style="mitre")
    parts = shapely.get_parts(whole)
    largest = parts[np.argmax(shapely.area(parts))]
    if not isinstance(largest, shapely.Polygon) or shapely.area(largest) < 0.99 * shapely.area(parts).sum():
        return None
    return _ring(largest)


def reflected(points: FloatArray, line: Segment) -> FloatArray:
    """Return points, shape (n, 2), reflected in the line through a segment."""
    start, normal = np.array(line.start), np.array(line.left)
    return np.asarray(points - 2.0 * ((points - start) @ normal)[:, None] * normal)


def are_alike(one: FloatArray, other: FloatArray, within_m: float) -> bool:
    """Return whether no point of either ring is further than a distance (m) from the other ring."""
    strings = [shapely.LinearRing(ring) for ring in (one, other)]
    return bool(shapely.hausdorff_distance(*strings) <= within_m)


def signed_area(ring: FloatArray) -> float:
    """Return the area in a ring of points, shape (n, 2): positive if it is counter-clockwise (m2)."""
    x, y = (ring - ring[0]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2.0


def perimeter(ring: FloatArray) -> float:
    """Return the length of a ring of points, shape (n, 2), m."""
    return float(shapely.LinearRing(ring).length)


def away_from(points: FloatArray, ring: FloatArray) -> FloatArray:
    """Return how far points, shape (n, 2), are from a ring's edges, shape (n,), m."""
    return np.asarray(shapely.distance(shapely.LinearRing(ring), shapely.points(points)))


def runs_along(lines: Sequence[FloatArray], rings: Sequence[FloatArray], within_m: float) -> list[bool]:
    """Return whether each line, shape (n, 2), runs along an edge of a ring for a part of it, and does not only cross.

    Args:
        lines: the lines (m).
        rings: the rings, each shape (n, 2), m.
        within_m: the largest distance of a line that runs along an edge (m).
    """
    shares = np.linspace(0.0, 1.0, _PLACES + 2)[1:-1]
    places = shapely.line_interpolate_point(
        np.array([shapely.LineString(line) for line in lines])[:, None], shares, normalized=True
    )
    edges = shapely.STRtree([shapely.LinearRing(ring) for ring in rings])
    near, _ = edges.query(places.ravel(), predicate="dwithin", distance=within_m)
    count = Counter(np.unique(near) // _PLACES)
    return [count[number] > 1 for number in range(len(lines))]


def simplified(ring: FloatArray, tolerance_m: float) -> FloatArray:
    """Return a ring of points, shape (n, 2), with fewer of them that deviates by at most a tolerance (m)."""
    closed = shapely.LineString(np.concatenate([ring, ring[:1]]))
    return np.asarray(shapely.get_coordinates(closed.simplify(tolerance_m, preserve_topology=False))[:-1])


def is_within(ring: FloatArray, around: FloatArray) -> bool:
    """Return whether a closed line, shape (n, 2), lies in another: a point within it does."""
    low, high = around.min(axis=0), around.max(axis=0)
    if np.any(ring.max(axis=0) < low) or np.any(ring.min(axis=0) > high):
        return False
    inner, outer = (shapely.make_valid(shapely.Polygon(line)) for line in (ring, around))
    return bool(shapely.covers(outer, shapely.point_on_surface(inner)))


def clipped(ring: FloatArray, clips: Sequence[Sequence[FloatArray]]) -> list[FloatArray] | None:
    """Return the rings that are left of one within all of some areas; None if all of it is within.

    Args:
        ring: the ring, shape (n, 2).
        clips: areas, each of one or more rings.
    """
    piece = shapely.make_valid(shapely.Polygon(ring))
    left = piece
    for areas in clips:
        area = shapely.union_all([shapely.make_valid(shapely.Polygon(area)) for area in areas])
        left = shapely.intersection(left, area)
    if shapely.area(left) >= (1.0 - 1e-6) * shapely.area(piece):
        return None
    parts = shapely.get_parts(left)
    return [_ring(part) for part in parts if isinstance(part, shapely.Polygon) and not shapely.is_empty(part)]


def is_clipped_away(line: FloatArray, clips: Sequence[Sequence[FloatArray]]) -> bool:
    """Return whether a line, shape (n, 2), lies wholly outside of one of some areas, each of one or more rings."""
    string = shapely.LineString(line)
    return any(
        not any(shapely.intersects(shapely.make_valid(shapely.Polygon(area)), string) for area in areas)
        for areas in clips
    )


def _once(lines: list[FloatArray], gap_m: float) -> list[FloatArray]:
    """Return the lines without those that run along a longer one, or an equal one before them."""
    strings = np.array([shapely.LineString(line) for line in lines])
    lengths, tree = shapely.length(strings), shapely.STRtree(strings)
    kept = np.ones(len(lines), dtype=bool)
    for number in np.argsort(lengths, kind="stable").tolist():
        if lengths[number] < _LONG * gap_m:
            continue
        start, end = (shapely.Point(lines[number][which]) for which in (0, -1))
        near = set(tree.query(start, "dwithin", gap_m).tolist()) & set(tree.query(end, "dwithin", gap_m).tolist())
        others = [n for n in near if n != number and kept[n] and lengths[n] >= lengths[number] - gap_m]
        kept[number] = not any(shapely.covers(shapely.buffer(strings[n], gap_m), strings[number]) for n in others)
    return [line for line, is_kept in zip(lines, kept, strict=True) if is_kept]


def _close_gaps(lines: list[FloatArray], gap_m: float) -> None:
    """Move ends that no other line reaches onto the nearest end or else the nearest line, if it is near enough.

    A line's own two ends meet only if it is much longer than the gap.
    """
    ends = np.array([line[end] for line in lines for end in (0, -1)])
    met = Counter(map(_key, ends))
    strings = np.array([shapely.LineString(line) for line in lines])
    tree = shapely.STRtree(strings)
    for number in range(len(ends)):
        line, end = divmod(number, 2)
        if met[_key(ends[number])] > 1:
            continue
        away = np.hypot(*(ends - ends[number]).T)
        away[number] = np.inf
        if np.hypot(*np.ptp(lines[line], axis=0)) < _LONG * gap_m:
            away[2 * line + 1 - end] = np.inf
        nearest = int(away.argmin())
        if away[nearest] <= gap_m:
            to = ends[nearest]
        else:
            point = shapely.Point(ends[number])
            near = [n for n in tree.query(point, "dwithin", gap_m) if n != line]
            if not near:
                continue
            best = strings[min(near, key=lambda n: float(shapely.distance(strings[n], point)))]
            to = shapely.get_coordinates(shapely.line_interpolate_point(best, shapely.line_locate_point(best, point)))[
                0
            ]
        met[_key(ends[number])] -= 1
        ends[number] = lines[line][-end] = to
        met[_key(to)] += 1


def _key(point: FloatArray) -> tuple[int, int]:
    x, y = (point / GRID_M).round().astype(int).tolist()
    return x, y


def _enclosing(cells: Sequence[shapely.Geometry]) -> list[FloatArray]:
    """Return the outer rings of cells that share edges."""
    whole = shapely.union_all(list(cells))
    return [_ring(part) for part in shapely.get_parts(whole) if isinstance(part, shapely.Polygon)]


def _ring(polygon: shapely.Polygon) -> FloatArray:
    return corners(shapely.get_coordinates(shapely.get_exterior_ring(polygon))[:-1])
