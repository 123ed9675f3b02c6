"""The curve of an edge: an arc through both corners and a handle, and the points that stand for it.

The curve is the image of an arc of a circle under a shear along the chord: an arc of a circle where the handle lies
over the middle of the chord, of an ellipse where it lies to one side. It is given in lengths of the chord, so that it
keeps its form when a corner is moved. The planner sees the points alone.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Final

import numpy as np
from pydantic import Field

from planner.cloth.outline import EDGE_MIN_M
from planner.geometry.pose import FloatArray, Point2
from planner.json_form import STRICT

CURVE_TOLERANCE_M: Final = 1e-3
"""Largest distance between a curve and the polygon that stands for it (m): less than a robot's grip can tell."""

CURVE_MAX: Final = 2.0
"""Largest distance of a handle from the middle of its chord, along it or across (chord lengths)."""


_STRAIGHT_RAD: Final = 1e-4
"""Half angle below which an arc differs from a parabola only by rounding (rad)."""


@dataclass(frozen=True, slots=True)
class Curve:
    """The handle of a curved edge: the middle of the curve, as seen from the middle of the chord.

    Attributes:
        along: its distance in the chord's direction (chord lengths).
        across: its distance to the left of the chord (chord lengths).
    """

    __pydantic_config__ = STRICT

    along: Annotated[float, Field(ge=-CURVE_MAX, le=CURVE_MAX)]
    across: Annotated[float, Field(ge=-CURVE_MAX, le=CURVE_MAX)]

    @property
    def turned(self) -> "Curve":
        """The same curve for the edge in the opposite direction."""
        return Curve(-self.along, -self.across)

    def handle(self, start: Point2, end: Point2) -> Point2:
        """Return where the handle is, of the edge between two corners (m)."""
        (ax, ay), (bx, by) = start, end
        x, y = bx - ax, by - ay
        return ((ax + bx) / 2 + self.along * x - self.across * y, (ay + by) / 2 + self.along * y + self.across * x)

    def points(self, start: Point2, end: Point2, tolerance_m: float = CURVE_TOLERANCE_M) -> list[Point2]:
        """Return the points between two corners (m), an odd number of them, so that the handle is one.

        Points nearer to each other than twice the shortest edge of an outline are left out.
        """
        ellipse = Ellipse.of(self, start, end)
        count = 2 * max(math.ceil(ellipse.half_angle_rad * math.sqrt(ellipse.radii_m[0] / (2.0 * tolerance_m)) / 2), 1)
        turns = ellipse.half_angle_rad * (2.0 * np.arange(1, count) / count - 1.0)
        return _spaced(start, ellipse.at(turns), end)


@dataclass(frozen=True, eq=False)
class Ellipse:
    """The ellipse that a curve runs along, from -half_angle_rad to half_angle_rad.

    Attributes:
        middle: the middle of the chord (m).
        along: the conjugate radius in the chord's direction (m), shape (2,).
        across: the conjugate radius to the handle (m), shape (2,).
        half_angle_rad: half the angle of the arc that was sheared (rad).
    """

    middle: FloatArray
    along: FloatArray
    across: FloatArray
    half_angle_rad: float

    @staticmethod
    def of(curve: Curve, start: Point2, end: Point2) -> "Ellipse":
        """Return the ellipse of the curve between two corners (m)."""
        a, b = np.array(start), np.array(end)
        chord = b - a
        to_handle = curve.along * chord + curve.across * np.array([-chord[1], chord[0]])
        half = max(2.0 * math.atan(2.0 * abs(curve.across)), _STRAIGHT_RAD)
        return Ellipse((a + b) / 2.0, chord / (2.0 * math.sin(half)), to_handle / (1.0 - math.cos(half)), half)

    @property
    def radii_m(self) -> tuple[float, float]:
        """The major and the minor radius (m)."""
        major, minor = np.linalg.svd(np.column_stack([self.along, self.across]), compute_uv=False)
        return float(major), float(minor)

    @property
    def turn_rad(self) -> float:
        """The direction of the major radius (rad)."""
        x, y = np.linalg.svd(np.column_stack([self.along, self.across]))[0][:, 0]
        return math.atan2(y, x)

    def at(self, turns_rad: FloatArray) -> FloatArray:
        """Return the points at some angles from the handle (m), shape (n, 2)."""
        rise = np.cos(turns_rad) - math.cos(self.half_angle_rad)
        return np.asarray(self.middle + np.outer(np.sin(turns_rad), self.along) + np.outer(rise, self.across))


def _spaced(start: Point2, points: FloatArray, end: Point2) -> list[Point2]:
    """Return the points without those too near to the one before or to the end."""
    kept: list[Point2] = []
    for x, y in points.tolist():
        if math.dist((x, y), kept[-1] if kept else start) >= 2 * EDGE_MIN_M <= math.dist((x, y), end):
            kept.append((x, y))
    return kept
