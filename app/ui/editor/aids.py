"""Editing aids drawn over the cloth: values that `app.ui.editor.aids_view` shows. Table frame, m."""

from dataclasses import dataclass

from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import Point2, Pose2
from planner.geometry.segment import Segment


@dataclass(frozen=True, slots=True)
class Ghost:
    """A fold that is being dragged.

    Attributes:
        line: the fold line, or the pointer's way so far where there is no fold line yet.
        is_red: whether the fold is red.
        landed: the corners of the moving part where it lands; empty while the fold is not legal.
    """

    line: Segment
    is_red: bool
    landed: tuple[tuple[Point2, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Pile:
    """The cloth as it lies before the next fold.

    Attributes:
        cloth: the layers.
        placement: the article frame in the table frame.
    """

    cloth: ClothState
    placement: Pose2


@dataclass(frozen=True, slots=True)
class Aids:
    """All aids at one moment.

    Attributes:
        handles: the points that can be grabbed, or have been placed.
        middles: points in the middle of edges, by which these are bent; smaller.
        chosen: the highlighted one of handles and middles: the one that is grabbed, or that closes an outline.
        lines: polylines; a polyline that ends at its beginning is closed.
        pile: the folded cloth on which a fold is drawn; None while it is the cloth that lies there.
        ghost: the fold that is being dragged.
    """

    handles: tuple[Point2, ...] = ()
    middles: tuple[Point2, ...] = ()
    chosen: int | None = None
    lines: tuple[tuple[Point2, ...], ...] = ()
    pile: Pile | None = None
    ghost: Ghost | None = None


NO_AIDS = Aids()


def closed(points: tuple[Point2, ...]) -> tuple[Point2, ...]:
    """Return a polyline closed by its first point."""
    return (*points, *points[:1])
