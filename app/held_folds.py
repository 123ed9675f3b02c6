"""Finds, for each fold of a drawing, the vertices to hold and the grips; also if a later fold is illegal."""

from collections.abc import Iterator

from app.document_state import HeldFold
from app.drawing.solution import Solution
from app.drawing.solve import radius_m
from planner.cloth.grips import grip_covers
from planner.cloth.must_hold import must_hold


def held_folds(solution: Solution, arms: int) -> Iterator[HeldFold]:
    """Yield, for each legal fold in the user's order, what a number of arms has to hold."""
    if solution.replay is None:
        return
    drawing = solution.drawing
    for fold, line, folded in zip(drawing.folds, solution.replay.lines, solution.folded, strict=False):
        support_angle_rad = drawing.scene.support_angle_rad
        vertices = must_hold(folded.moving, line.left, (line,), support_angle_rad)
        found = grip_covers(folded.moving, vertices, radius_m(drawing, fold), arms)
        yield HeldFold(found.vertices, found.covers[0] if found.covers else (), found.count)
