"""Find where a garment can lie wholly on the table: a grid of placements."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from planner.cloth.garment import Garment
from planner.geometry.pose import Point2, Pose2
from planner.geometry.table import Table
from planner.geometry.tolerance import LENGTH_M


@dataclass(frozen=True, slots=True)
class Room:
    """The displacements of a garment with which it lies wholly on the table.

    Attributes:
        low: the smallest move along x and y of the table frame (m).
        high: the largest move (m).
    """

    low: Point2
    high: Point2

    @staticmethod
    def of(garment: Garment, placement: Pose2, table: Table) -> "Room":
        """Return the room around a garment with this placement."""
        points = placement.to_outer(np.array(garment.outline))
        (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
        x, y = table.depth_m / 2, table.width_m / 2
        return Room((float(-x - x0), float(-y - y0)), (float(x - x1), float(y - y1)))

    @property
    def is_none(self) -> bool:
        """Whether the garment is larger than the table."""
        return any(high < low - LENGTH_M for low, high in zip(self.low, self.high, strict=True))

    def hangs_no_more(self, dx_m: float, dy_m: float) -> bool:
        """Return whether after this move the garment hangs over no edge by more than where it lies now, or not at all.

        One that is longer than the table may move as far as it hangs over the same edges.
        """
        moves = zip(self.low, (dx_m, dy_m), self.high, strict=True)
        return all(min(low, high, 0.0) - LENGTH_M <= by <= max(low, high, 0.0) + LENGTH_M for low, by, high in moves)

    @property
    def nearest(self) -> Point2:
        """The smallest move that brings it wholly onto the table; (0, 0) if it already lies there."""
        x, y = (min(max(0.0, low), high) for low, high in zip(self.low, self.high, strict=True))
        return (x, y)

    def moves(self, step_m: float) -> Iterator[tuple[int, int]]:
        """Yield all moves by whole steps along x and y that the room holds, as numbers of steps."""
        if not self.is_none:
            columns, rows = (_steps(low, high, step_m) for low, high in zip(self.low, self.high, strict=True))
            yield from ((i, j) for i in columns for j in rows)


def turned_in_place(garment: Garment, placement: Pose2, quarters: int) -> Pose2:
    """Turn a placement by quarter turns, keeping the middle of the outline's bounding box in place."""
    outline = np.array(garment.outline)
    middle = (outline.min(axis=0) + outline.max(axis=0)) / 2
    turned = Pose2(placement.x_m, placement.y_m, placement.yaw_rad + quarters * math.pi / 2)
    dx, dy = placement.to_outer(middle) - turned.to_outer(middle)
    return turned.moved(float(dx), float(dy))


def _steps(low: float, high: float, step_m: float) -> range:
    return range(math.ceil((low - LENGTH_M) / step_m), math.floor((high + LENGTH_M) / step_m) + 1)
