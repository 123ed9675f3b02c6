"""Trailing strips: parts of cloth that a drag leaves behind, though Theorem 2 does not ask for their vertices.

The theorem looks at the convex hull. A slit that opens sideways parts such a strip from the cloth ahead of it, and the
hull hides its tip: a leg of trousers behind the other one. Cloth is pulled along straight lines within it, and not
pushed; the tip is pulled only round the end of the slit, a reflex corner, by what comes in at the strip's root. Lines
that lead there from the rear side of the tip make an angle with the drag whose tangent is the strip's length by its
width. Beyond 45 degrees they pull more across the drag than along it, so that the strip turns about its root and its
tip stays where friction holds it. So the tip of a strip that is longer than wide must be held as well, by a grip on the
strip.

In simulated drags the jeans' leg, 4.8 times as long as wide, stayed behind by 11 to 13 cm, and a romper's leg, 1.4
times as long as wide, stayed behind too; sleeves .9 times as long as wide came along.
"""

import math

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

LONG = 1.0
"""A trailing strip that is longer than that times its width must be held."""


def strip_tips(piece: Region, up: Point2) -> FloatArray:
    """Return the leading corners at the tips of the trailing strips that a drag would leave behind, shape (n, 2), m.

    Args:
        piece: the cloth that is dragged.
        up: the unit vector of the drag, in the frame of the piece.
    """
    ahead, across = np.array(up), np.array([-up[1], up[0]])
    found = []
    for slit in Region.polygon(piece.hull).difference(piece).pieces:
        tip = _trailing_end(slit.coordinates, piece.hull, ahead)
        width = 0.0 if tip is None else _width_behind(piece, slit, ahead, across)
        if tip is not None and 0.0 < LONG * width < np.ptp(slit.coordinates @ across):
            found.append(tip)
    return np.array(found).reshape(-1, 2)


def are_lost(grips: FloatArray, vertices: FloatArray, tips: FloatArray, up: Point2) -> BoolArray:
    """Return which vertices grips do not hold because those are tips of trailing strips, shape (n, k).

    A strip is held by a grip on it: one across the slit does not pull it.

    Args:
        grips: the grips, shape (n, 2), m.
        vertices: the vertices that must be held, the tips among them, shape (k, 2), m.
        tips: the strips' leading corners, as `strip_tips` returns them, shape (t, 2), m.
        up: the unit vector of the drag.
    """
    offsets = grips[:, None] - vertices
    is_tip = (np.abs(vertices[:, None] - tips).max(axis=2) <= LENGTH_M).any(axis=1)
    return np.asarray(is_tip & (offsets @ np.array(up) > LENGTH_M))  # the slit is ahead of the tip


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
