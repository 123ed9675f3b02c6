"""The area of a drawing on the table in which the pointer may draw."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from app.drawing.drawing import Drawing
from app.drawing.ring import ring_of
from planner.geometry.pose import Point2
from planner.geometry.table_top import TableTop


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

    def holds(self, point: Point2) -> bool:
        """Return whether a point of the table frame is on the ground."""
        return all(low <= place <= high for low, place, high in zip(self.low, point, self.high, strict=True))


def on_table(drawing: Drawing, points: Iterable[Point2]) -> tuple[Point2, ...]:
    """Return points of the article frame in the table frame (m)."""
    placed = drawing.placement.to_outer(np.array(list(points), dtype=float).reshape(-1, 2))
    return tuple((float(x), float(y)) for x, y in placed)


def in_article(drawing: Drawing, point: Point2) -> Point2:
    """Return a point of the table frame in the article frame (m)."""
    x, y = drawing.placement.to_inner(np.array(point))
    return (float(x), float(y))
