"""What is wrong with an outline, all of it and where; the planner's own check stops at the first fault."""

import math
from collections.abc import Iterator, Sequence
from itertools import islice

from app.drawing.problem import Problem
from planner.cloth.outline import EDGE_MIN_M, crossings, require_simple_outline
from planner.errors import GarmentError
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment

TOLD_MAX = 20
"""So many faults of one outline are told at most."""


def outline_problems(outline: Sequence[Point2]) -> tuple[Problem, ...]:
    """Why an outline is none; empty for a good one."""
    try:
        require_simple_outline(outline)
    except GarmentError as error:
        shown = tuple(islice(_problems(outline), TOLD_MAX))
        return shown or (Problem("outline_too_small", error.field, error.message, points=tuple(outline)),)
    return ()


def _problems(outline: Sequence[Point2]) -> Iterator[Problem]:
    count = len(outline)
    if count < 3:
        have = "no points yet" if count == 0 else f"{count} point{'' if count == 1 else 's'}"
        yield Problem("outline_unfinished", "outline", f"has {have}, it needs 3", points=tuple(outline))
        return
    lengths = [math.dist(point, outline[(i + 1) % count]) for i, point in enumerate(outline)]
    short = [i for i, length_m in enumerate(lengths) if length_m < EDGE_MIN_M]
    if short:
        yield from (_short_edge(outline, i, lengths[i]) for i in short)
        return
    yield from (_crossing(outline, i, j, meeting) for i, j, meeting in crossings(outline))


def _short_edge(outline: Sequence[Point2], edge: int, length_m: float) -> Problem:
    after = (edge + 1) % len(outline)
    message = f"edge {edge} from point {edge} to point {after} is {length_m * 1000:.3f} mm long, less than 1 mm"
    return Problem("edge_too_short", f"outline[{after}]", message, points=(outline[edge], outline[after]))


def _crossing(outline: Sequence[Point2], i: int, j: int, meeting: Point2) -> Problem:
    edges = tuple(Segment(outline[edge], outline[(edge + 1) % len(outline)]) for edge in (i, j))
    message = f"edges {i} and {j} cross at ({meeting[0]:.3f}, {meeting[1]:.3f}) m"
    return Problem("outline_crosses", f"outline[{j}]", message, points=(meeting,), lines=edges)
