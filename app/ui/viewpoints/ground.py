"""Where a drawing lies on the table."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from app.drawing.drawing import Drawing
from app.drawing.ring import ring_of
from planner.geometry.pose import Point2
from planner.geometry.table import TableTop


@dataclass(frozen=True, slots=True)
class Ground:
    """The rectangle in which there may be cloth: the table, and what hangs beside it rolled out flat.

    Attributes:
        low: smallest x and y, table frame (m).
        high: largest x and y (m).
    """

    low: Point2
    high: Point2

    @staticmethod
    def of(drawing: Drawing) -> "Ground":
        """Return the ground of a drawing."""
        top = TableTop.of(drawing.scene.table)
        corners = np.array([top.low, top.high, *on_table(drawing, ring_of(drawing.outline).points)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        return Ground((float(low[0]), float(low[1])), (float(high[0]), float(high[1])))


def on_table(drawing: Drawing, points: Iterable[Point2]) -> tuple[Point2, ...]:
    """Return points of the article frame in the table frame (m)."""
    placed = drawing.placement.to_outer(np.array(list(points), dtype=float).reshape(-1, 2))
    return tuple((float(x), float(y)) for x, y in placed)
