"""A drawing as it was read, whatever the format of its file: curves, and which of them mean folds."""

from dataclasses import dataclass, field
from typing import Any

from app.files.curve import Curve


@dataclass(frozen=True, eq=False)
class FoldLine:
    """A line that means a fold.

    Attributes:
        kind: "blue" or "red".
        curve: the line, in the direction in which it was drawn.
        name: what it is called; None if it has no name.
        grip_radius_m: how far round itself one grip holds the cloth (m); None: as the article's.
    """

    kind: str
    curve: Curve
    name: str | None = None
    grip_radius_m: float | None = None


@dataclass(frozen=True, eq=False)
class Sketch:
    """A drawing. Its y axis goes up.

    Attributes:
        curves: those that may be the outline, or a part of it.
        folds: the lines that mean folds, in the file's order.
        unit_m: how long one unit is (m); None: the file does not say.
        why_no_unit: why not, as the beginning of a sentence.
        title: what the drawing is called; None if it has no name.
        kept: what Pleat wrote into a drawing that it exported, beside the lines.
        notes: what is to be said about it, in sentences.
    """

    curves: tuple[Curve, ...]
    folds: tuple[FoldLine, ...]
    unit_m: float | None
    why_no_unit: str = ""
    title: str | None = None
    kept: dict[str, Any] | None = None
    notes: tuple[str, ...] = field(default=())
