"""Lines about which all of the cloth is turned over: they lie along its edge, with all cloth to their left."""

import math

import numpy as np

from planner.errors import FoldError
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M
from planner.message import Message

TOUCH_MIN_M = 0.05
"""How much of the cloth's edge lies on the line at least (m): about a point the cloth would swing."""


def snapped_turn(start: Point2, end: Point2, silhouette: Region) -> Segment:
    """Return the stretch of the silhouette's edge along a line, in its direction, with all cloth to its left.

    The stretch goes from the first corner on the line to the last; cloth in between may keep clear of it.

    Raises:
        FoldError: the line is more than 5 mm from an edge that has all cloth to its left, or too little of the edge
            lies on it.
    """
    drawn = Segment(start, end)
    stretches = [edge for edge in _edges(silhouette) if np.dot(edge.direction, drawn.direction) > 0.0]
    offs = [float(np.abs(drawn.left_distances(np.array([edge.start, edge.end]))).max()) for edge in stretches]
    near = [edge for edge, off_m in zip(stretches, offs, strict=True) if off_m <= SNAP_M]
    if near:
        edge = max(near, key=lambda edge: edge.length)
    elif abs(drawn.left_distances(silhouette.hull).min()) <= SNAP_M:
        edge = drawn  # it touches a corner
    else:
        off_m = abs(float(drawn.left_distances(silhouette.hull).min()))
        text = f"the line is {off_m * 1000:.1f} mm from the edge about which to turn; {SNAP_M * 1000:g} mm are snapped"
        raise FoldError("start", Message("turn_off_edge", text, {"off_m": off_m, "most_m": SNAP_M}))
    touch_m = _touching(silhouette, edge)
    if touch_m < TOUCH_MIN_M - LENGTH_M:
        text = f"the line touches the cloth along {touch_m * 1000:.1f} mm; {TOUCH_MIN_M * 1000:g} mm must lie on it"
        raise FoldError("end", Message("turn_touches_little", text, {"touch_m": touch_m, "least_m": TOUCH_MIN_M}))
    return edge


def is_turn(line: Segment, silhouette: Region) -> bool:
    """Return whether a line is snapped: it stays where it is."""
    try:
        snapped = snapped_turn(line.start, line.end, silhouette)
    except FoldError:
        return False
    return math.dist(line.start, snapped.start) <= LENGTH_M and math.dist(line.end, snapped.end) <= LENGTH_M


def nearest_turn(silhouette: Region, guide: Segment) -> Segment | None:
    """Return the edge line nearest to a segment's middle, of those nearly parallel to it; None if there is none.

    The segment may run either way.
    """
    middle = guide.at(guide.length / 2.0)
    alike = (edge for edge in _edges(silhouette) if abs(np.dot(edge.direction, guide.direction)) >= math.sqrt(0.5))
    for edge in sorted(alike, key=lambda edge: float(edge.distances(np.array([middle]))[0])):
        try:
            return snapped_turn(edge.start, edge.end, silhouette)
        except FoldError:
            continue
    return None


def whole(silhouette: Region, _line: Segment) -> Region:
    """Return the whole silhouette: all of it moves."""
    return silhouette


def _edges(silhouette: Region) -> list[Segment]:
    """Return the edges of the silhouette's convex hull, each from the first corner on its line to the last."""
    hull = silhouette.hull
    found = []
    for start, end in zip(hull, np.roll(hull, -1, axis=0), strict=True):
        edge = Segment(tuple(start.tolist()), tuple(end.tolist()))
        on_it = hull[np.abs(edge.left_distances(hull)) <= LENGTH_M]
        along = edge.positions(on_it)
        first, last = on_it[np.argmin(along)], on_it[np.argmax(along)]
        found.append(Segment(tuple(first.tolist()), tuple(last.tolist())))
    return found


def _touching(silhouette: Region, line: Segment) -> float:
    """Return how much of the silhouette's boundary lies on a line, to the snapping distance (m)."""
    touch_m = 0.0
    for ring in silhouette.rings:
        is_on = np.abs(line.left_distances(ring)) <= SNAP_M
        sides = np.abs(np.diff(line.positions(ring), append=line.positions(ring[:1])))
        touch_m += float(sides[is_on & np.roll(is_on, -1)].sum())
    return touch_m
