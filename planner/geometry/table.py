"""The table: a rectangle whose middle is the origin of the table frame."""

from dataclasses import dataclass

from planner.geometry.pose import Point2


@dataclass(frozen=True, slots=True)
class Table:
    """A rectangular table top.

    Attributes:
        depth_m: extent along x, away from the station `front` (m).
        width_m: extent along y (m).
        height_m: of the top above the floor (m).
    """

    depth_m: float = 1.60
    width_m: float = 0.98
    height_m: float = 0.79

    @property
    def corners(self) -> tuple[Point2, Point2, Point2, Point2]:
        """The four corners in the table frame (m), counter-clockwise from near right."""
        x, y = self.depth_m / 2, self.width_m / 2
        return ((-x, -y), (x, -y), (x, y), (-x, y))
