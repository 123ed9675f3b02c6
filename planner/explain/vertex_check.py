"""Check why a corner of the part that a fold moves must be held, or need not be (paper, Theorem 1).

While it is folded the part stands over the fold line, held by the hands: "above" a corner is what lies further from the
line. A corner must be held unless it is on the line, or is no corner of the convex hull, or has cloth above it.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from planner.cloth.must_hold import must_hold
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, grid_key


class Support(StrEnum):
    """The support of a corner, if there is any."""

    HANGS_FREELY = "hangs_freely"
    ON_THE_LINE = "on_the_line"
    WITHIN_THE_HULL = "within_the_hull"
    CLOTH_ABOVE = "cloth_above"
    CLOTH_NEARLY_ABOVE = "cloth_nearly_above"


@dataclass(frozen=True, slots=True)
class VertexCheck:
    """A corner of the part that a fold moves.

    Attributes:
        point: its position before the fold, article frame (m).
        support: what holds it.
    """

    point: Point2
    support: Support

    @property
    def must_be_held(self) -> bool:
        """Whether a hand must hold it."""
        return self.support is Support.HANGS_FREELY


def vertex_checks(part: Region, line: Segment, support_angle_rad: float) -> tuple[VertexCheck, ...]:
    """Return the check of every corner of the part that moves, counter-clockwise.

    Args:
        part: the silhouette of the part, article frame.
        line: the fold line; the part is to its left.
        support_angle_rad: the angle from straight above within which cloth counts as above (rad).
    """
    free = _keys(must_hold(part, line.left, (line,), support_angle_rad))
    not_straight = _keys(must_hold(part, line.left, (), 0.0))
    hull = _keys(part.hull)
    found = []
    for vertex in np.vstack(part.rings):
        key = _key(vertex)
        if key in free:
            support = Support.HANGS_FREELY
        elif line.distances(vertex[None])[0] <= LENGTH_M:
            support = Support.ON_THE_LINE
        elif key not in hull:
            support = Support.WITHIN_THE_HULL
        else:
            support = Support.CLOTH_NEARLY_ABOVE if key in not_straight else Support.CLOTH_ABOVE
        found.append(VertexCheck((float(vertex[0]), float(vertex[1])), support))
    return tuple(found)


def _keys(points: FloatArray) -> set[tuple[int, int]]:
    return {_key(point) for point in points}


def _key(point: FloatArray) -> tuple[int, int]:
    return (grid_key(point[0]), grid_key(point[1]))
