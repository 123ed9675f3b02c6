"""A template: a kind of garment that a few measures define, with its folds."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from app.templates.measure import Measure, Measures
from planner.cloth.garment import DEFAULT_GRIP_RADIUS_M, DEFAULT_THICKNESS_M, DrawnFold, Garment
from planner.errors import GarmentError
from planner.geometry.pose import Point2, Pose2
from planner.geometry.table import Table
from planner.message import Message
from planner.strict_model import LARGEST_M

NEAR_EDGE_X_M = -Table().depth_m / 2
"""The x of the default table's near edge, table frame (m)."""

INSIDE_M = 0.05
"""Distance from that edge to the cloth (m)."""


@dataclass(frozen=True, slots=True)
class Cut:
    """A pattern made from measures.

    Attributes:
        outline: the pattern's corners, garment frame (m).
        folds: the folds in their order.
        placement: the garment frame in the table frame.
    """

    outline: tuple[Point2, ...]
    folds: tuple[DrawnFold, ...]
    placement: Pose2


@dataclass(frozen=True, slots=True)
class Template:
    """A kind of garment.

    Attributes:
        name: its name, and that of the garments made from it.
        title: its displayed name.
        text: its shape and folds, in a sentence.
        areal_density_kg_m2: the cloth's mass per area (kg/m2).
        measures: the measures, in the order in which to ask for them.
        cut: makes the pattern from the measures; raises `MeasureError` if they do not fit each other.
        thickness_m: the cloth's thickness where fingers press it (m).
    """

    name: str
    title: str
    text: str
    areal_density_kg_m2: float
    measures: tuple[Measure, ...]
    cut: Callable[[Measures], Cut]
    thickness_m: float = DEFAULT_THICKNESS_M

    def garment(self, given: Mapping[str, float], title: str | None = None) -> Garment:
        """Return the garment with these measures, and defaults for the others.

        Raises:
            MeasureError: a measure is out of range, or does not fit another.
            GarmentError: the outline is invalid, or the title is too long.
        """
        return self.made(Measures(self.measures, given), title)

    def made(self, measures: Measures, title: str | None = None) -> Garment:
        """Return the garment with all its measures; raise as `garment` does, except for measures out of range."""
        cut = self.cut(measures)
        _require_within_bounds(cut.outline)
        return Garment(
            self.name,
            self.title if title is None else title,
            cut.outline,
            self.areal_density_kg_m2,
            cut.folds,
            DEFAULT_GRIP_RADIUS_M,
            cut.placement,
            self.thickness_m,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the template as JSON, with the garment that its defaults give."""
        garment = self.garment({})
        return {
            "name": self.name,
            "title": self.title,
            "text": self.text,
            "measures": [
                {field: getattr(measure, field) for field in ("name", "label", "text", "default_m", "min_m", "max_m")}
                for measure in self.measures
            ],
            "outline": [list(point) for point in garment.outline],
            "folds": [{"kind": fold.kind, "start": list(fold.start), "end": list(fold.end)} for fold in garment.folds],
        }


def _require_within_bounds(outline: tuple[Point2, ...]) -> None:
    """Raise `GarmentError` if an outline exceeds the limits of a garment file."""
    far_m = max(abs(coordinate) for point in outline for coordinate in point)
    if far_m > LARGEST_M:
        text = f"reaches {far_m:.3g} m from where it begins, at most {LARGEST_M:g} m"
        raise GarmentError("outline", Message("outline_too_large", text, {"far_m": far_m, "most_m": LARGEST_M}))


def fold(name: str, start: Point2, end: Point2) -> DrawnFold:
    """Return a fold of all layers; the cloth to the left of start -> end moves."""
    return DrawnFold(name, "blue", start, end)


def lying_across(outline: tuple[Point2, ...]) -> Pose2:
    """Return the placement with the garment's x along the table's, its lowest x nearest to the robot.

    The garment is centred across the table; the robot stands at the front.
    """
    xs, ys = zip(*outline, strict=True)
    return Pose2(NEAR_EDGE_X_M + INSIDE_M - min(xs), -(min(ys) + max(ys)) / 2, 0.0)


def lying_away(outline: tuple[Point2, ...], inside_m: float = INSIDE_M, beside_m: float = 0.0) -> Pose2:
    """Return the placement with the garment's y along the table's x, its lowest y nearest to the robot at the front.

    Args:
        outline: the pattern's corners (m).
        inside_m: the distance from the table's near edge (m).
        beside_m: the shift of its middle to the left of the table's (m).
    """
    xs, ys = zip(*outline, strict=True)
    return Pose2(NEAR_EDGE_X_M + inside_m - min(ys), beside_m + (min(xs) + max(xs)) / 2, -math.pi / 2)


def lying_towards(outline: tuple[Point2, ...], beside_m: float = 0.0) -> Pose2:
    """Return the placement with the garment's y against the table's x, its highest y nearest to the robot.

    Args:
        outline: the pattern's corners (m).
        beside_m: the shift of its middle to the left of the table's (m).
    """
    xs, ys = zip(*outline, strict=True)
    return Pose2(NEAR_EDGE_X_M + INSIDE_M + max(ys), beside_m - (min(xs) + max(xs)) / 2, math.pi / 2)
