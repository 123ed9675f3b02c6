"""Checks of a ring of points that is to be the outline of a garment."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from planner.errors import GarmentError
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.message import Message

POINTS_MAX = 400
EDGE_MIN_M = 1e-3
AREA_MIN_M2 = 1e-4


def require_simple_outline(outline: Sequence[Point2]) -> None:
    """Refuse an outline that is no simple polygon of a sensible size.

    Raises:
        GarmentError: fewer than 3 or more than 400 points, an edge shorter than 1 mm, edges that cross
            or touch, less than 1 cm^2 of cloth; the field names the point or the edge.
    """
    count = len(outline)
    if not 3 <= count <= POINTS_MAX:
        text = f"has {count} points, it needs 3 to {POINTS_MAX}"
        raise GarmentError("outline", Message("outline_points", text, {"points": count, "most": POINTS_MAX}))
    _require_long_edges(outline)
    _require_no_crossing(outline)
    area = Region.polygon(outline).area
    if area < AREA_MIN_M2:
        text = f"its area is {area:.6f} m^2, less than {AREA_MIN_M2} m^2"
        raise GarmentError("outline", Message("outline_area", text, {"area_m2": area, "least_m2": AREA_MIN_M2}))


def _require_long_edges(outline: Sequence[Point2]) -> None:
    for i, point in enumerate(outline):
        following = (i + 1) % len(outline)
        length = math.dist(point, outline[following])
        if length < EDGE_MIN_M * (1.0 - ANGLE_RAD):
            raise GarmentError(f"outline[{following}]", edge_too_short(i, following, length))


def _require_no_crossing(outline: Sequence[Point2]) -> None:
    for i, j, (x, y) in crossings(outline):
        raise GarmentError(f"outline[{j}]", edges_cross(i, j, (x, y)))


def edge_too_short(edge: int, following: int, length_m: float) -> Message:
    """Return the message about an edge that is shorter than an outline may have (m)."""
    return Message(
        "edge_too_short",
        f"edge {edge} from point {edge} to point {following} is {length_m * 1000:.3f} mm long, "
        f"less than {EDGE_MIN_M * 1000:g} mm",
        {"edge": edge, "from": edge, "to": following, "length_m": length_m, "least_m": EDGE_MIN_M},
    )


def edges_cross(first: int, second: int, at: Point2) -> Message:
    """Return the message about two edges that cross at a point (m)."""
    text = f"edges {first} and {second} cross at ({at[0]:.3f}, {at[1]:.3f}) m"
    return Message("edges_cross", text, {"edges": [first, second], "at": list(at)})


def crossings(outline: Sequence[Point2]) -> Iterator[tuple[int, int, Point2]]:
    """Yield every pair of edges that cross, touch, or (neighbours) run back over one another, ascending, and where (m).

    Edge i runs from corner i to the next; no edge may have length 0.
    """
    count = len(outline)
    edges = [Segment(outline[i], outline[(i + 1) % count]) for i in range(count)]
    for i, j in _pairs_near_crossing(np.array(outline)):
        are_neighbours = j == i + 1 or (i == 0 and j == count - 1)
        meeting = _fold_back(edges, i, j) if are_neighbours else edges[i].meeting_point(edges[j])
        if meeting is not None:
            yield i, j, meeting


def _pairs_near_crossing(starts: FloatArray) -> list[tuple[int, int]]:
    """Return the pairs of edges, ascending, that may meet: neither lies clearly beside the other or beyond its ends."""
    ends = np.roll(starts, -1, axis=0)
    along = ends - starts
    left = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
    offsets = (left * starts).sum(axis=1)[:, None]
    sides = left @ starts.T - offsets, left @ ends.T - offsets
    straddles = (np.minimum(*sides) <= LENGTH_M) & (np.maximum(*sides) >= -LENGTH_M)
    low, high = np.minimum(starts, ends), np.maximum(starts, ends) + 2.0 * LENGTH_M
    are_beside = (low[:, None] <= high).all(axis=2)
    return [(int(i), int(j)) for i, j in np.argwhere(np.triu(straddles & straddles.T & are_beside & are_beside.T, 1))]


def _fold_back(edges: list[Segment], i: int, j: int) -> Point2 | None:
    """Return the point where neighbouring edges begin to run back over one another, or None."""
    first, second = (edges[j], edges[i]) if i == 0 and j == len(edges) - 1 and j > 1 else (edges[i], edges[j])
    (ax, ay), (bx, by) = first.direction, second.direction
    is_reversed = ax * bx + ay * by < 0.0 and abs(ax * by - ay * bx) <= ANGLE_RAD
    return second.start if is_reversed else None
