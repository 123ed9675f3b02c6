"""What is wrong with a drawing: the field, a sentence, and the place where it can be shown."""

from dataclasses import dataclass
from typing import Any

from planner.geometry.pose import Point2
from planner.geometry.segment import Segment
from planner.message import Message


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing for which there can be no plan.

    Attributes:
        code: what kind of thing, for programs.
        field: the field it stands in, as in ``outline[3]`` or ``folds[0].start``.
        message: what is wrong, with the numbers and their units.
        fold: the fold's index, or None.
        points: where, article frame (m).
        lines: what is to be marked there (an edge, a fold's line), article frame (m).
        says: the message as data, where it has numbers.
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
        """Field and sentence."""
        return f"{self.field}: {self.message}" if self.field else self.message

    def to_dict(self) -> dict[str, Any]:
        """The problem as JSON."""
        return {
            "code": self.code,
            "field": self.field,
            "message": self.message,
            "says": self.says and self.says.to_dict(),
            "fold": self.fold,
            "points": [list(point) for point in self.points],
            "lines": [[list(line.start), list(line.end)] for line in self.lines],
        }
