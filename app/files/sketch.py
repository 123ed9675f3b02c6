"""A drawing as read from a file of any format: its curves, and which of them mean folds."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias, get_args

from app.files.curve import Curve
from app.files.piece_labels import in_order

Role: TypeAlias = Literal["outline", "white", "page", "fold", "mirror"]
"""What a drawn line may be. White areas without an edge and frames, and then the page, are an outline only if nothing
else is."""


@dataclass(frozen=True, eq=False)
class FoldLine:
    """A line that means a fold.

    Attributes:
        kind: the fold's kind, as `FOLD_KINDS` names it.
        curve: the line, in the direction drawn.
        name: its name, or None.
        grip_radius_m: the radius of cloth that one grip holds (m); None for the garment's.
    """

    kind: str
    curve: Curve
    name: str | None = None
    grip_radius_m: float | None = None


@dataclass(frozen=True, eq=False)
class MirrorLine:
    """A line along which a half piece is folded when it is cut, so that the cloth is the piece and its mirror image.

    Attributes:
        curve: the line; its ends alone matter.
        is_beside: whether it may run beside the edge that it means, as an arrow does.
    """

    curve: Curve
    is_beside: bool = False


@dataclass(frozen=True, eq=False)
class DrawnLine:
    """A line of a drawing, and what it may be.

    Attributes:
        role: what it may be.
        line: the line, as its role has it.
        size: the graded size that it belongs to; None for all of them.
    """

    role: Role
    line: Curve | FoldLine | MirrorLine
    size: str | None = None


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
        faint: further curves that may be the outline if those before them are none: white areas, the page.
        mirrors: the lines along which half pieces are folded.
        says_fold: whether a text says that a piece is cut on the fold, wherever that is.
        sizes: the drawing in each graded size, by name, in order; empty if it has one size.
        sample: the size that the drawing names as its sample; None if it names none.
        piece: the pattern piece that is wanted, by name or number; None for the largest.
    """

    curves: tuple[Curve, ...]
    folds: tuple[FoldLine, ...]
    unit_m: float | None
    why_no_unit: str = ""
    title: str | None = None
    kept: dict[str, Any] | None = None
    notes: tuple[str, ...] = field(default=())
    faint: tuple[tuple[Curve, ...], ...] = ()
    mirrors: tuple[MirrorLine, ...] = ()
    says_fold: bool = False
    sizes: Mapping[str, "Sketch"] = field(default_factory=dict)
    sample: str | None = None
    piece: str | None = None

    def with_lines(self, drawn: Iterable[DrawnLine]) -> "Sketch":
        """Return the sketch with lines; with all those of each size in `sizes` where they have several sizes."""
        lines = list(drawn)
        sizes = in_order({one.size for one in lines if one.size is not None and one.role == "outline"})
        if len(sizes) < 2:
            return self._of(lines)
        by_size = {size: self._of(one for one in lines if one.size in (None, size)) for size in sizes}
        return replace(self._of(lines), sizes=by_size)

    def _of(self, drawn: Iterable[DrawnLine]) -> "Sketch":
        by_role: dict[str, list[Any]] = {role: [] for role in get_args(Role)}
        for one in drawn:
            by_role[one.role].append(one.line)
        return replace(
            self,
            curves=tuple(by_role["outline"]),
            folds=tuple(by_role["fold"]),
            faint=(tuple(by_role["white"]), tuple(by_role["page"])),
            mirrors=tuple(by_role["mirror"]),
        )
