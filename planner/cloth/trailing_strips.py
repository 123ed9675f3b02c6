"""Tongues of cloth that a drag leaves behind, though Theorem 2 does not ask for their vertices.

The theorem looks at the convex hull. A slit that opens sideways parts a tongue from the cloth ahead of it, and the hull
hides its tip: a leg of trousers behind the other one. Cloth is pulled but not pushed, so only a short tongue follows
its root; a long one stays where friction holds it, and turns about its root. In simulated drags
(docs/rehearsal.md) the jeans' leg, 4.8 times as long as wide, stayed behind by 11 to 13 cm; tongues up to
1.3 times as long as wide are what the other shipped articles have.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

LONG = 2.0
"""A tongue that is longer than that times its width stays behind."""


def strip_left_behind(piece: Region, up: Point2) -> Point2 | None:
    """Return the leading corner at the tip of the longest tongue that a drag leaves behind, None if there is none.

    Args:
        piece: the cloth that is dragged.
        up: the unit vector of the drag, in the frame of the piece.
    """
    ahead, across = np.array(up), np.array([-up[1], up[0]])
    found: list[tuple[float, Point2]] = []
    for slit in Region.polygon(piece.hull).difference(piece).pieces:
        tip = _trailing_end(slit.coordinates, piece.hull, ahead)
        if tip is None:
            continue
        length = float(np.ptp(slit.coordinates @ across))
        width = _width_behind(piece, slit, ahead, across)
        if 0.0 < LONG * width < length:
            found.append((length, (float(tip[0]), float(tip[1]))))
    return max(found)[1] if found else None


def _trailing_end(slit: FloatArray, hull: FloatArray, ahead: FloatArray) -> FloatArray | None:
    """Return the end of a slit's mouth at which the cloth behind it begins; None where it opens ahead or behind."""
    starts, ends = hull, np.roll(hull, -1, axis=0)
    for start, end in zip(starts, ends, strict=True):
        edge = Segment((float(start[0]), float(start[1])), (float(end[0]), float(end[1])))
        mouth = slit[edge.distances(slit) <= LENGTH_M]
        if len(mouth) < 2:
            continue
        at = mouth @ ahead
        span = mouth[at.argmax()] - mouth[at.argmin()]
        if np.ptp(at) > LENGTH_M and abs(float(span @ ahead)) > math.sqrt(0.5) * float(np.hypot(*span)):
            return np.asarray(mouth[at.argmin()])
    return None


def _width_behind(piece: Region, slit: Region, ahead: FloatArray, across: FloatArray) -> float:
    """Return how far the cloth reaches behind a slit, against the drag, halfway along it (m)."""
    sides = slit.coordinates @ across
    foot = (sides.min() + sides.max()) / 2.0 * across
    low, high = ((piece.coordinates @ ahead).min() - LENGTH_M, (piece.coordinates @ ahead).max() + LENGTH_M)
    (ax, ay), (bx, by) = foot + low * ahead, foot + high * ahead
    line = Segment((float(ax), float(ay)), (float(bx), float(by)))
    gap, cloth = (_stretches(region, line) for region in (slit, piece))
    return next((end - start for start, end in cloth if abs(end - gap[0][0]) <= 3.0 * LENGTH_M), 0.0) if gap else 0.0


def _stretches(region: Region, line: Segment) -> list[tuple[float, float]]:
    """Return the stretches of a line within a region, by their distances from its start, rising (m)."""
    found = (line.positions(np.array(ends)).tolist() for ends in region.overlaps_with(line))
    return sorted((min(ends), max(ends)) for ends in found)
