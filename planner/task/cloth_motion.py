"""The motion of the cloth in a stretch of time."""

from dataclasses import dataclass

from planner.geometry.pose import Pose2
from planner.geometry.table_top import TableTop


@dataclass(frozen=True, slots=True)
class ClothMotion:
    """What the cloth does in a phase.

    Attributes:
        done: the folds finished before, as a bit mask.
        start: the article's placement at the start of the phase (article frame in table frame).
        end: the same at its end; in between it is interpolated.
        fold: the fold in progress, or None.
        sweep: how far that fold is at the start and the end of the phase: 0 flat, 1 standing over
            the fold line (the apex), 2 laid down.
        top: the top over which cloth does not hang; open where it is held out beyond an edge.
    """

    done: int
    start: Pose2
    end: Pose2
    top: TableTop
    fold: int | None = None
    sweep: tuple[float, float] = (0.0, 0.0)
