"""Find where cloth ends in a direction: the stretches of boundaries ahead of which there is no cloth."""

from collections.abc import Iterable
from dataclasses import dataclass

import shapely
from shapely.geometry.base import BaseGeometry

from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import GRID_M

_AHEAD_M = 1e-3
"""Distance ahead of a point at which there must be cloth for the point to lie behind some (m)."""

_SLACK_M = 2 * GRID_M
"""Margin for coordinates that are rounded to the grid (m)."""


@dataclass(frozen=True)
class Front:
    """Stretches of boundaries ahead of which there may be no cloth.

    Attributes:
        lines: the stretches; for this package only.
        towards: the direction, a unit vector.
    """

    lines: BaseGeometry
    towards: Point2

    @staticmethod
    def of(regions: Iterable[Region], seams: Iterable[Segment], always: Region, towards: Point2) -> "Front":
        """Return the boundary stretches of regions and the seams ahead of which there may be no cloth.

        Args:
            regions: regions that may be covered, each by itself.
            seams: lines that may become boundaries.
            always: the region that is covered in every case.
            towards: the direction, a unit vector.
        """
        ends = [shapely.difference(r.shape.boundary, _behind(r, towards)) for r in regions]
        lines = [shapely.LineString([seam.start, seam.end]) for seam in seams]
        whole = shapely.union_all([*ends, *lines])
        return Front(shapely.difference(whole, _behind(always, towards)), towards)

    def is_near(self, region: Region, radius_m: float) -> bool:
        """Return whether a stretch lies within a radius of a region of cloth, and not just behind it."""
        lines = shapely.difference(self.lines, _behind(region, self.towards))
        return not shapely.is_empty(lines) and bool(shapely.dwithin(lines, region.shape, radius_m))


def _behind(region: Region, towards: Point2) -> BaseGeometry:
    """Return the places that have the region just ahead of them."""
    x, y = towards
    back = shapely.transform(region.shape, lambda points: points - [_AHEAD_M * x, _AHEAD_M * y])
    return shapely.buffer(back, _SLACK_M)
