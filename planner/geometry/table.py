"""The table: a rectangle whose middle is the origin of the table frame, and the boxes of which it is made.

A robot's base drives under the edges, so the legs stand where the base does not come: well inside, with their middles
`LEG_INSET_X_M` and `LEG_INSET_Y_M` from the edges. At the paper's table, 1.60 m by 0.98 m, they then stand 4 cm beside
the base of a PR2 at each of its five stations. Under a smaller table they move together.
"""

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Interval

from planner.errors import SceneError
from planner.geometry.pose import Point2, Point3
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
