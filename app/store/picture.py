"""Thumbnails of drawings, outline and fold lines, for lists of documents and versions."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.drawing.curve import Curve
from app.drawing.drawing import Corner
from app.drawing.ring import ring_of
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.geometry.pose import Point2


@dataclass(frozen=True, slots=True)
class PictureFold:
    """A fold line, garment frame (m)."""

    kind: str
    start: Point2
    end: Point2


@dataclass(frozen=True, slots=True)
class Picture:
    """The thumbnail of a drawing.

    Attributes:
        outline: the polygon that stands for the outline, garment frame (m).
        folds: the fold lines in the user's order.
    """

    outline: tuple[Point2, ...] = ()
    folds: tuple[PictureFold, ...] = ()

    @staticmethod
    def of(drawing: Mapping[str, Any]) -> "Picture":
        """Return the picture of a drawing as it is written in a file; an empty one if it is damaged."""
        try:
            outline = ring_of(tuple(_corner(corner) for corner in drawing["outline"])).points
            folds = tuple(
                PictureFold(_kind(fold["kind"]), _point(fold["start"]["point"]), _point(fold["end"]["point"]))
                for fold in drawing["folds"]
            )
        except (ArithmeticError, AttributeError, KeyError, TypeError, ValueError):
            return Picture()
        return Picture(outline, folds)


def _corner(corner: Mapping[str, Any]) -> Corner:
    curve = corner.get("curve")
    return Corner("", _point(corner["point"]), Curve(curve["along"], curve["across"]) if curve else None)


def _kind(kind: Any) -> str:  # noqa: ANN401
    return FOLD_KINDS[kind].name


def _point(pair: Any) -> Point2:  # noqa: ANN401
    x, y = (float(number) for number in pair)
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError(pair)
    return (x, y)
