"""The table: a rectangle whose middle is the origin of the table frame."""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Interval

from planner.errors import SceneError
from planner.geometry.pose import Point2
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
