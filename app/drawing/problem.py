"""A problem of a drawing: the field, a sentence, and the places to mark."""

from dataclasses import dataclass
from typing import Any

from planner.geometry.pose import Point2
from planner.geometry.segment import Segment
from planner.message import Message


@dataclass(frozen=True, slots=True)
class Problem:
    """A problem that prevents planning.

    Attributes:
        code: the kind of problem, for programs.
        field: the field at fault, as in ``outline[3]`` or ``folds[0].start``.
        message: the problem in words, with numbers and units.
        fold: the fold's index, or None.
        points: the points to mark, garment frame (m).
        lines: the lines to mark (an edge, a fold's line), garment frame (m).
        says: the message as data, if it has numbers.
    """

    code: str
    field: str
    message: str
    fold: int | None = None
    points: tuple[Point2, ...] = ()
    lines: tuple[Segment, ...] = ()
    says: Message | None = None

    @property
    def text(self) -> str:
        """The field and the message."""
        return f"{self.field}: {self.message}" if self.field else self.message

    def to_dict(self) -> dict[str, Any]:
        """Return the problem as JSON."""
        return {
            "code": self.code,
            "field": self.field,
            "message": self.message,
            "says": self.says and self.says.to_dict(),
            "fold": self.fold,
            "points": [list(point) for point in self.points],
            "lines": [[list(line.start), list(line.end)] for line in self.lines],
        }
