"""Rules of drawing by hand: what a pointer snaps to, when an outline closes, what folds are called, what is refused.

Both editors keep them. The 3D view's calls these functions. The board cannot ask the server at every move of a hand: it
has the numbers and sentences from `static/js/board/rules.js`, which `app.drawing.page_rules` writes, and tests hold its
own snapping, corners and names against these.
"""

import math
from collections.abc import Collection, Iterator, Sequence
from itertools import chain, count, pairwise
from typing import Final, Literal, TypeAlias

import numpy as np

from planner.cloth.outline import EDGE_MIN_M, POINTS_MAX
from planner.geometry.pose import Point2
from planner.geometry.region import Region

SNAP_PX: Final = {
    "close": 12.0,
    "vertex": 10.0,
    "dropped": 8.0,
    "fraction": 9.0,
    "bisector": 8.0,
    "edge": 8.0,
    "guides": 6.0,
    "guide": 6.0,
    "grid": 4.0,
    "line": 4.0,
}
"""The snapping distance of each kind of target (px), the strongest kind first; the 3D view has no grid or guides."""

FRACTIONS: Final = ((1, 2), (1, 3), (2, 3), (1, 4), (3, 4))
"""The fractions of an edge that a pointer snaps to, as numerator and denominator."""

HANDLE_PX: Final = 12.0
"""The distance within which a mouse grabs a handle (px)."""

FINGER_PX: Final = 22.0
"""The same for a finger (px), and for any pointer in the 3D view, where fingers are not told from mice."""

LEAST_CORNERS: Final = 3
"""The fewest corners with which an outline can be closed."""

SAME_CORNER_M: Final = EDGE_MIN_M
"""Distance below which two corners are one (m)."""

STROKE_MIN_M: Final = 0.002
"""Length below which a line is no fold yet (m)."""

SIDES: Final = {"along_y": "left over", "against_y": "right over", "along_x": "top down", "against_x": "bottom up"}
"""A fold's first name by the direction of its line: the side from which the cloth comes; article frame, its y up."""

DRAW_FOLD: Final = "Draw fold"
DRAW_OUTLINE: Final = "Draw outline"
MOVE_CORNER: Final = "Move vertex"
BEND_EDGE: Final = "Bend edge"

NO_CLOTH: Final = "there is no cloth yet: draw an outline first"
CORNER_TAKEN: Final = "there is a corner already"
TOO_MANY_CORNERS: Final = f"an outline has at most {POINTS_MAX} corners"
TOO_FEW_CORNERS: Final = "an outline has at least three corners"

NextCorner: TypeAlias = Literal["put", "close", "taken", "full"]


def as_sentence(text: str) -> str:
    """Return a text with an initial capital letter and a final full stop."""
    return f"{text[:1].upper()}{text[1:]}" + ("" if text.endswith((".", "!", "?")) else ".")


def snapped(seen: Region, point: Point2, pixel_m: float) -> Point2:
    """Return the corner, the fraction of an edge or the point of an edge that a pointer at a point means.

    Args:
        seen: the cloth.
        point: the pointer's point, in the frame of the cloth (m); returned where nothing is near enough.
        pixel_m: the distance between neighbouring pixels there (m).
    """
    ((x, y),) = seen.nearest_boundary_points(np.array([point]))
    corners = [(float(u), float(v)) for ring in seen.rings for u, v in ring]
    targets = (("vertex", corners), ("fraction", list(_fractions(seen))), ("edge", [(float(x), float(y))]))
    for kind, places in targets:
        place = nearest_within(places, point, SNAP_PX[kind] * pixel_m)
        if place is not None:
            return place
    return point


def nearest_within(places: Collection[Point2], point: Point2, far_m: float) -> Point2 | None:
    """Return the place nearest to a point, if it is no further than this (m)."""
    near = min(places, key=lambda place: math.dist(place, point), default=None)
    return near if near is not None and math.dist(near, point) <= far_m else None


def snapped_corner(points: Sequence[Point2], point: Point2, pixel_m: float) -> Point2:
    """Return the corner of an unfinished outline that a pointer at a point means, or the point.

    Args:
        points: the corners so far.
        point: the pointer's point, in their frame (m).
        pixel_m: the distance between neighbouring pixels there (m).
    """
    if len(points) >= LEAST_CORNERS and math.dist(points[0], point) <= SNAP_PX["close"] * pixel_m:
        return points[0]
    return nearest_within(points[:-1], point, SNAP_PX["vertex"] * pixel_m) or point


def snapped_handle(start: Point2, end: Point2, point: Point2, pixel_m: float) -> Point2:
    """Return the handle of an edge that a pointer at a point means: a straight edge, half a circle, an arc, or any.

    Args:
        start: the corner at which the edge begins, in the pointer's frame (m).
        end: the corner at which it ends (m).
        point: the pointer's point (m).
        pixel_m: the distance between neighbouring pixels there (m).
    """
    a, b, at = np.array(start), np.array(end), np.array(point)
    chord, middle = b - a, (a + b) / 2.0
    rise = np.array([-chord[1], chord[0]])
    square = max(float(chord @ chord), np.finfo(float).tiny)
    straight = a + min(max(float((at - a) @ chord) / square, 0.0), 1.0) * chord
    half_circles = (middle + rise / 2.0, middle - rise / 2.0)
    arc = middle + float((at - middle) @ rise) / square * rise
    for kind, handles in (("dropped", (straight,)), ("fraction", half_circles), ("bisector", (arc,))):
        place = nearest_within([(float(x), float(y)) for x, y in handles], point, SNAP_PX[kind] * pixel_m)
        if place is not None:
            return place
    return point


def next_corner(points: Sequence[Point2], point: Point2) -> NextCorner:
    """Return what becomes of an unfinished outline where its next corner is put at a point.

    At its first corner or, as with a double click, at its last it closes.
    """
    ends = {points[0], points[-1]} if len(points) >= LEAST_CORNERS else set()
    if any(math.dist(end, point) < SAME_CORNER_M for end in ends):
        return "close"
    if any(math.dist(other, point) < SAME_CORNER_M for other in points):
        return "taken"
    return "full" if len(points) >= POINTS_MAX else "put"


def fold_name(direction: Point2, taken: Collection[str]) -> str:
    """Return a fold's first name from its line's direction, with a number if the name is taken."""
    x, y = direction
    upright, level = SIDES["along_y" if y > 0 else "against_y"], SIDES["along_x" if x > 0 else "against_x"]
    name = level if abs(x) > abs(y) else upright
    return next(each for each in chain((name,), (f"{name} {n}" for n in count(2))) if each not in taken)


def _fractions(seen: Region) -> Iterator[Point2]:
    """Yield the fractions of every edge."""
    for ring in seen.rings:
        for (ax, ay), (bx, by) in pairwise([*ring, ring[0]]):
            for part, whole in FRACTIONS:
                share = part / whole
                yield (float(ax + share * (bx - ax)), float(ay + share * (by - ay)))
