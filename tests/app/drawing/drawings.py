"""Drawings that tests start from."""

from dataclasses import replace
from typing import Any

import pytest

from app.drawing.drawing import Corner, Crease, Drawing, End, Tie
from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from planner.cloth.garment import Garment
from planner.geometry.pose import Point2
from tests.app.samples import towel


def towel_drawing(*folds: Crease, **changes: Any) -> Drawing:
    """Return a towel of 0.4 x 0.3 m; by default its near half is folded over y = 0.15."""
    drawing = solve(drawing_of(Garment.from_dict(towel(**changes)))).drawing
    return replace(drawing, folds=folds) if folds else drawing


def crease(name: str, start: Point2 | End, end: Point2 | End, kind: str = "blue") -> Crease:
    start, end = (point if isinstance(point, End) else End(point) for point in (start, end))
    return Crease(name, name, kind, start, end)


def tied(point: Point2, tie: Tie) -> End:
    return End(point, tie)


def about(part: float) -> float:
    """Return a number that equals all those next to it, for a tie to compare with."""
    return pytest.approx(part)  # type: ignore[return-value]


def pulled(drawing: Drawing, corner: int, dx_m: float, dy_m: float) -> Drawing:
    """Return the drawing with one corner pulled."""
    x, y = drawing.outline[corner].point
    return with_corner(drawing, corner, (x + dx_m, y + dy_m))


def with_corner(drawing: Drawing, corner: int, point: Point2) -> Drawing:
    outline = list(drawing.outline)
    outline[corner] = replace(outline[corner], point=point)
    return replace(drawing, outline=tuple(outline))


def outlined(drawing: Drawing, *points: Point2) -> Drawing:
    """Return the drawing with another outline."""
    return replace(drawing, outline=tuple(Corner(f"v{i}", point) for i, point in enumerate(points)))
