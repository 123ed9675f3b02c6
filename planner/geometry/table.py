"""The table: a rectangle whose middle is the origin of the table frame, and the boxes of which it is made.

A robot's base drives under the edges, so the legs stand where the base does not come: well inside, with their middles
`LEG_INSET_X_M` and `LEG_INSET_Y_M` from the edges. At the paper's table, 1.60 m by 0.98 m, they then stand 4 cm beside
the base of a PR2 at each of its five stations. Under a smaller table they move together.
"""

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from annotated_types import Interval

from planner.errors import SceneError
from planner.geometry.pose import FloatArray, Point2, Point3
from planner.geometry.tolerance import LENGTH_M
from planner.json_form import NULL_IS_DEFAULT, require_intervals

_Side = Annotated[float, Interval(ge=0.1, le=10.0), NULL_IS_DEFAULT]


@dataclass(frozen=True, slots=True)
class Table:
    """A rectangular table top.

    Attributes:
        depth_m: extent along x, away from the station `front` (m).
        width_m: extent along y (m).
        height_m: height of the top above the floor (m).
    """

    depth_m: _Side = 1.60
    width_m: _Side = 0.98
    height_m: _Side = 0.79

    def __post_init__(self) -> None:
        """Refuse sizes out of range; raises `SceneError`."""
        require_intervals(self, SceneError)

    @property
    def corners(self) -> tuple[Point2, Point2, Point2, Point2]:
        """The four corners in the table frame (m), counter-clockwise from near right."""
        x, y = self.depth_m / 2, self.width_m / 2
        return ((-x, -y), (x, -y), (x, y), (-x, y))


TOP_THICKNESS_M = 0.03
LEG_WIDTH_M = 0.05
LEG_INSET_X_M = 0.45
LEG_INSET_Y_M = 0.25


@dataclass(frozen=True, slots=True)
class TablePart:
    """A box with its sides parallel to the table's.

    Attributes:
        name: its name for people.
        center: its middle, table frame (m).
        size: its extents along x, y and z (m).
    """

    name: str
    center: Point3
    size: Point3


def table_parts(table: Table) -> tuple[TablePart, ...]:
    """Return the top, its upper side at z = 0, and the four legs down to the floor."""
    thickness = min(TOP_THICKNESS_M, table.height_m / 2)
    top = TablePart("table top", (0.0, 0.0, -thickness / 2), (table.depth_m, table.width_m, thickness))
    height = table.height_m - thickness
    x, y = _inset(table.depth_m, LEG_INSET_X_M), _inset(table.width_m, LEG_INSET_Y_M)
    places = (("near left", -x, y), ("near right", -x, -y), ("far left", x, y), ("far right", x, -y))
    legs = (
        TablePart(f"{name} table leg", (dx, dy, -thickness - height / 2), (LEG_WIDTH_M, LEG_WIDTH_M, height))
        for name, dx, dy in places
    )
    return (top, *legs)


def _inset(extent_m: float, inset_m: float) -> float:
    """Return how far from the middle the legs stand (m), at least half their width."""
    return max(extent_m / 2 - inset_m, LEG_WIDTH_M / 2)


@dataclass(frozen=True, slots=True)
class TableTop:
    """The rectangle on which cloth does not hang, and the map of the unrolled plane over its edges.

    Cloth beyond the table hangs straight down. In the unrolled plane it lies flat beyond the edge. A point there, at
    distance h beyond the table and at height z above the plane, is in space the nearest point of the table at height
    z - h. The map keeps lengths and has a crease at the edge.

    Attributes:
        low: the smallest x and y (m).
        high: the largest x and y (m); a side may be at infinity where cloth is held out beyond it.
    """

    low: Point2
    high: Point2

    @staticmethod
    def of(table: Table) -> "TableTop":
        """Return a table's top."""
        x, y = table.depth_m / 2, table.width_m / 2
        return TableTop((-x, -y), (x, y))

    def open_towards(self, points: FloatArray) -> "TableTop":
        """Return the top extended without end beyond every edge over which one of the points lies, shape (n, 2)."""
        low, high = points.min(axis=0), points.max(axis=0)
        return TableTop(
            (
                -math.inf if low[0] < self.low[0] - LENGTH_M else self.low[0],
                -math.inf if low[1] < self.low[1] - LENGTH_M else self.low[1],
            ),
            (
                math.inf if high[0] > self.high[0] + LENGTH_M else self.high[0],
                math.inf if high[1] > self.high[1] + LENGTH_M else self.high[1],
            ),
        )

    def covers(self, points: FloatArray) -> bool:
        """Return whether points, shape (..., 2 or 3), all lie on the top in the unrolled plane, to the tolerance."""
        places = points[..., :2].reshape(-1, 2)
        if not len(places):
            return True
        (x0, y0), (x1, y1) = places.min(axis=0).tolist(), places.max(axis=0).tolist()
        (left, near), (right, far) = self.low, self.high
        is_within_x = left - LENGTH_M <= x0 and x1 <= right + LENGTH_M
        return bool(is_within_x and near - LENGTH_M <= y0 and y1 <= far + LENGTH_M)

    def room_m(self, points: FloatArray) -> float:
        """Return how far inside the edges points of the unrolled plane, shape (n, 2 or 3), all lie (m); 0 beyond."""
        places = points[:, :2]
        return max(float(np.minimum(places - self.low, np.subtract(self.high, places)).min(initial=math.inf)), 0.0)

    def beyond(self, points: FloatArray) -> FloatArray:
        """Return how far points, shape (..., 2 or 3), lie beyond the top in the unrolled plane (m); 0 on it."""
        out = points[..., :2] - np.minimum(np.maximum(points[..., :2], self.low), self.high)
        return np.asarray(np.hypot(out[..., 0], out[..., 1]))

    def over_edge(self, points: FloatArray) -> FloatArray:
        """Map points of the unrolled plane with their heights, shape (..., 3), over the edge.

        Args:
            points: place in the unrolled plane, table frame, and height above it (m).

        Returns:
            The points in space, table frame (m).
        """
        if self.covers(points):
            return points.copy()
        nearest, _, beyond = self.edge_beside(points)
        return np.concatenate([nearest, (points[..., 2] - beyond)[..., None]], axis=-1)

    def clear_of_edge(self, points: FloatArray, clear_m: float, rest_m: float) -> FloatArray:
        """Map points of the unrolled plane over the edge as `over_edge` does, but keep them clear of the edge's plane.

        A point at rest keeps clear however little it is beyond the edge. A point that rises towards the edge approaches
        the plane gradually, until it is as high above the top as it is high at rest.

        Args:
            points: place in the unrolled plane, table frame, and height above it, shape (..., 3), m.
            clear_m: the distance to keep outside the plane (m).
            rest_m: the height above the plane at which points rest (m).

        Returns:
            The points in space, table frame (m).
        """
        found = self.over_edge(points)
        if clear_m > 0.0 and not self.covers(points):
            _, outwards, beyond = self.edge_beside(points)
            whole = np.clip(beyond + points[..., 2] - rest_m, LENGTH_M, rest_m)
            found[..., :2] += outwards * (clear_m * np.minimum(beyond / whole, 1.0))[..., None]
        return found

    def edge_beside(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the nearest points on the top, the unit directions away from them, and the distances (m)."""
        nearest = np.minimum(np.maximum(points[..., :2], self.low), self.high)
        out = points[..., :2] - nearest
        beyond = np.hypot(out[..., 0], out[..., 1])
        return nearest, out / np.where(beyond > 0.0, beyond, 1.0)[..., None], beyond
