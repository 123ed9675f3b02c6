"""Finds, for each fold of a drawing, the vertices to hold and the grips; also if a later fold is illegal."""

from collections.abc import Iterator
from dataclasses import dataclass

from app.drawing.solution import Solution
from app.drawing.solve import radius_m
from planner.cloth.grips import grip_covers
from planner.cloth.must_hold import must_hold
from planner.geometry.pose import Point2


@dataclass(frozen=True, slots=True)
class FoldCheck:
    """The vertices and grips of one fold.

    Attributes:
        must_hold: the vertices that must be held, garment frame (m).
        grips: the fewest that hold them (m), empty if there are too few arms; for pages, those of the plan,
            which may have a hand more so that corners are held firmly.
        grips_needed: the number of the fewest; None if there are too few arms.
    """

    must_hold: tuple[Point2, ...]
    grips: tuple[Point2, ...]
    grips_needed: int | None


@dataclass(frozen=True, slots=True)
class FoldChecks:
    """The vertices and grips of the folds.

    Attributes:
        version: the document's version that they belong to.
        folds: the entries, one for each legal fold.
    """

    version: int
    folds: tuple[FoldCheck, ...]


def held_folds(solution: Solution, arms: int) -> Iterator[FoldCheck]:
    """Yield, for each legal fold in the user's order, what a number of arms has to hold."""
    if solution.replay is None:
        return
    drawing = solution.drawing
    for fold, line, folded in zip(drawing.folds, solution.replay.lines, solution.folded, strict=False):
        support_angle_rad = drawing.scene.support_angle_rad
        vertices = must_hold(folded.moving, line.left, (line,), support_angle_rad)
        found = grip_covers(folded.moving, vertices, radius_m(drawing, fold), arms)
        yield FoldCheck(found.vertices, found.covers[0] if found.covers else (), found.count)
