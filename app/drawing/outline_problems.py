"""Finds all problems of an outline and their positions; the planner's own check stops at the first."""

import math
from collections.abc import Iterator
from itertools import islice

from app.drawing.problem import Problem
from app.drawing.ring import Ring
from planner.cloth.outline import EDGE_MIN_M, crossings, edge_too_short, edges_cross, require_simple_outline
from planner.errors import GarmentError
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment

TOLD_MAX = 20
"""Largest number of problems reported for one outline."""


def outline_problems(ring: Ring) -> tuple[Problem, ...]:
    """Return the problems of an outline, by its corners and the edges between them; empty if it is valid."""
    try:
        require_simple_outline(ring.points)
    except GarmentError as error:
        shown = tuple(islice(_problems(ring), TOLD_MAX))
        other = Problem("outline_too_small", error.field, error.message, points=ring.points, says=error.says)
        return shown or (other,)
    return ()


def _problems(ring: Ring) -> Iterator[Problem]:
    outline = ring.points
    count = len(outline)
    if count < 3:
        have = "no points yet" if count == 0 else f"{count} point{'' if count == 1 else 's'}"
        yield Problem("outline_unfinished", "outline", f"has {have}, it needs 3", points=outline)
        return
    lengths = [math.dist(point, outline[(i + 1) % count]) for i, point in enumerate(outline)]
    short = [i for i, length_m in enumerate(lengths) if length_m < EDGE_MIN_M]
    if short:
        yield from (_short_edge(ring, i, lengths[i]) for i in short)
        return
    yield from (_crossing(ring, i, j, meeting) for i, j, meeting in crossings(outline))


def _short_edge(ring: Ring, edge: int, length_m: float) -> Problem:
    after = (edge + 1) % len(ring.points)
    corner, following = ring.corner(edge), ring.corner(after)
    says = edge_too_short(corner, following, length_m)
    ends = (ring.points[edge], ring.points[after])
    return Problem("edge_too_short", f"outline[{following}]", says.text, points=ends, says=says)


def _crossing(ring: Ring, i: int, j: int, meeting: Point2) -> Problem:
    edges = tuple(Segment(ring.points[edge], ring.points[(edge + 1) % len(ring.points)]) for edge in (i, j))
    first, second = ring.corner(i), ring.corner(j)
    says = edges_cross(first, second, meeting)
    return Problem("outline_crosses", f"outline[{second}]", says.text, points=(meeting,), lines=edges, says=says)
