"""A drawing as read from a file of any format: its curves, and which of them mean folds."""

from dataclasses import dataclass, field
from typing import Any

from app.files.curve import Curve


@dataclass(frozen=True, eq=False)
class FoldLine:
    """A line that means a fold.

    Attributes:
        kind: "blue" or "red".
        curve: the line, in the direction drawn.
        name: its name, or None.
        grip_radius_m: the radius of cloth that one grip holds (m); None for the article's.
    """

    kind: str
    curve: Curve
    name: str | None = None
    grip_radius_m: float | None = None


@dataclass(frozen=True, eq=False)
class Sketch:
    """A drawing. Its y axis points up.

    Attributes:
        curves: the curves that may be the outline, or part of it.
        folds: the lines that mean folds, in the file's order.
        unit_m: the length of its unit (m); None if the file does not say.
        why_no_unit: why the unit is unknown, as the beginning of a sentence.
        title: its title, or None.
        kept: the data that Pleat stored in a drawing that it exported, besides the lines.
        notes: remarks on the drawing, in sentences.
    """

    curves: tuple[Curve, ...]
    folds: tuple[FoldLine, ...]
    unit_m: float | None
    why_no_unit: str = ""
    title: str | None = None
    kept: dict[str, Any] | None = None
    notes: tuple[str, ...] = field(default=())
