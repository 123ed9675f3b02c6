"""Solves a drawing: replays its folds in order, each on the cloth that the previous ones left.

An illegal fold stays as drawn. Solving stops there, since the cloth that the later folds would find is unknown.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

from app.drawing.drawing import Crease, Drawing
from app.drawing.fold_line import find_line
from app.drawing.problem import Problem
from app.drawing.ring import Ring, ring_of
from app.drawing.solution import Solution, steps_of
from app.drawing.ties import Names
from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import FIRST_IS_RED, DrawnFold, Garment
from planner.cloth.outline import EDGE_MIN_M, crossings, edge_too_short, edges_cross, require_simple_outline
from planner.errors import GarmentError
from planner.folds.attachment import Replay
from planner.folds.fold_cloth import Folded
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.message import Message

TOLD_MAX = 20
"""Largest number of problems reported for one outline."""


def solve(drawing: Drawing) -> Solution:
    """Return the drawing with its folds found on the cloth, and its problems."""
    problems = [*_scene_problems(drawing)]
    ring = ring_of(drawing.outline)
    faults = _outline_problems(ring)
    if faults:
        return Solution(drawing, (*faults, *problems), None, (), None, None, [])
    names = Names.of(drawing)
    replay = Replay(ring.points, (ClothState.spread_out(Region.polygon(ring.points)),))
    folded: list[Folded] = []
    folds: list[Crease] = []
    for index, crease in enumerate(drawing.folds):
        problem = _red_first(crease, index)
        found = problem or find_line(crease, index, replay, names, radius_m(drawing, crease))
        if isinstance(found, Problem):
            problems.insert(0, found)
            break
        replay = replay.then(found.line, found.folded.cloth)
        folded.append(found.folded)
        folds.append(found.crease)
    solved = replace(drawing, folds=(*folds, *drawing.folds[len(folds) :]))
    spread = garment_of(replace(solved, folds=tuple(folds)))
    steps = steps_of(replay, folded)
    return Solution(solved, tuple(problems), replay, tuple(folded), None if problems else spread, spread, steps)


def garment_of(drawing: Drawing) -> Garment:
    """Return the drawn garment, with the folds' ends as points; raise `GarmentError` if it is invalid."""
    return Garment(
        drawing.name,
        drawing.title,
        ring_of(drawing.outline).points,
        drawing.areal_density_kg_m2,
        tuple(
            DrawnFold(fold.name, fold.kind, fold.start.point, fold.end.point, radius_m(drawing, fold))
            for fold in drawing.folds
        ),
        drawing.grip_radius_m,
        drawing.placement,
        drawing.thickness_m,
    )


def radius_m(drawing: Drawing, crease: Crease) -> float:
    """Return a fold's grip radius (m): its own, or the garment's."""
    return drawing.grip_radius_m if crease.grip_radius_m is None else crease.grip_radius_m


def _red_first(crease: Crease, index: int) -> Problem | None:
    if index > 0 or not crease.is_red:
        return None
    ends = (crease.start.point, crease.end.point)
    return Problem("fold_illegal", "folds[0].kind", FIRST_IS_RED, 0, ends)


def _scene_problems(drawing: Drawing) -> list[Problem]:
    names = [name for name, _ in drawing.scene.stations]
    if drawing.start_station in names:
        return []
    text = f"expected one of {', '.join(names)}; got {drawing.start_station!r}"
    says = Message("unknown_station", text, {"station": drawing.start_station, "stations": names})
    return [Problem("unknown_station", "start_station", text, says=says)]


def _outline_problems(ring: Ring) -> tuple[Problem, ...]:
    """Return all problems of an outline, by its corners and the edges between them; the planner stops at the first."""
    try:
        require_simple_outline(ring.points)
    except GarmentError as error:
        shown = tuple(islice(_faults(ring), TOLD_MAX))
        other = Problem("outline_too_small", error.field, error.message, points=ring.points, says=error.says)
        return shown or (other,)
    return ()


def _faults(ring: Ring) -> Iterator[Problem]:
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
