"""Finds all problems of an outline and their positions; the planner's own check stops at the first."""

import math
from collections.abc import Iterator, Sequence
from itertools import islice

from app.drawing.problem import Problem
from planner.cloth.outline import EDGE_MIN_M, crossings, edge_too_short, edges_cross, require_simple_outline
from planner.errors import GarmentError
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment

TOLD_MAX = 20
"""Largest number of problems reported for one outline."""


def outline_problems(outline: Sequence[Point2]) -> tuple[Problem, ...]:
    """Return the problems of an outline; empty if it is valid."""
    try:
        require_simple_outline(outline)
    except GarmentError as error:
        shown = tuple(islice(_problems(outline), TOLD_MAX))
        other = Problem("outline_too_small", error.field, error.message, points=tuple(outline), says=error.says)
        return shown or (other,)
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
    says = edge_too_short(edge, after, length_m)
    ends = (outline[edge], outline[after])
    return Problem("edge_too_short", f"outline[{after}]", says.text, points=ends, says=says)


def _crossing(outline: Sequence[Point2], i: int, j: int, meeting: Point2) -> Problem:
    edges = tuple(Segment(outline[edge], outline[(edge + 1) % len(outline)]) for edge in (i, j))
    says = edges_cross(i, j, meeting)
    return Problem("outline_crosses", f"outline[{j}]", says.text, points=(meeting,), lines=edges, says=says)
