"""What is drawn over the cloth while somebody edits: values, which `app.ui.editor.aids_view` shows. Table frame, m."""

from dataclasses import dataclass

from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import Point2, Pose2
from planner.geometry.segment import Segment


@dataclass(frozen=True, slots=True)
class Ghost:
    """A fold that is being dragged.

    Attributes:
        line: where it would be, or, while that is nowhere, where the pointer has gone.
        is_red: its kind.
        landed: the corners of what it moves, where that comes to lie; empty while it would not be legal.
    """

    line: Segment
    is_red: bool
    landed: tuple[tuple[Point2, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Pile:
    """The cloth as it lies when it is time for the next fold.

    Attributes:
        cloth: the layers.
        placement: the article frame in the table frame.
    """

    cloth: ClothState
    placement: Pose2


@dataclass(frozen=True, slots=True)
class Aids:
    """Everything at one moment.

    Attributes:
        handles: what can be grabbed, or has been placed.
        chosen: the handle that stands out: the one that is grabbed, or the one that closes an outline.
        lines: polylines; one that comes back to its beginning is closed.
        pile: the folded cloth on which a fold is drawn; None while it is the one that lies there.
        ghost: the fold that is being dragged.
    """

    handles: tuple[Point2, ...] = ()
    chosen: int | None = None
    lines: tuple[tuple[Point2, ...], ...] = ()
    pile: Pile | None = None
    ghost: Ghost | None = None


NO_AIDS = Aids()


def closed(points: tuple[Point2, ...]) -> tuple[Point2, ...]:
    """A polyline that comes back to its beginning."""
    return (*points, *points[:1])
