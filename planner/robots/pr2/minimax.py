"""The worst of several places that are all to be reached in one approach, in the best approach for it. Compiled.

Approaches are examined in the order of their lower bounds, and of a place no more is searched than what would beat the
best approach so far. See `planner.robots.pr2.nearest_comfort` for the search for one place.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.arm_gap import comfort_gap
from planner.robots.pr2.nearest_comfort import MANY_QUERIES, ROOM_QUERIES, directions_from, nearest_comfort
from planner.robots.pr2.requirements import (
    Requirements,
    Scratch,
    aim_of,
    aims_gap,
    meets_query,
    rooms_tested,
    scratch_for,
)


class Ranking(NamedTuple):
    """Approaches in the order in which they are examined.

    Attributes:
        gaps: lower bounds on how far each place is out of reach in each approach (m), shape (k, p).
        bounds: the largest of them for each approach (m), shape (k,).
        order: the approaches, the least bound first, shape (k,).
    """

    gaps: FloatArray
    bounds: FloatArray
    order: NDArray[np.int64]


class Minimax(NamedTuple):
    """The least of the worst shortfalls of some places, in the approaches examined so far.

    Attributes:
        short_m: how far the worst place must be displaced in the best approach (m); infinite where none is better than
            what matters.
        place: the worst place; -1 if there is none, or all are within the comfort radius.
        approach: the best approach; the one that is nearest by length where `short_m` is infinite.
        examined: the number of approaches examined, of those in the order of the ranking.
    """

    short_m: float
    place: int
    approach: int
    examined: int


@kernel
def ranked(shape: ArmShape, query: Requirements, places: FloatArray) -> tuple[Ranking, Minimax]:
    """Return the order in which `minimax` examines the approaches, and its result before the first."""
    gaps = np.full((len(query.axes), len(places)), math.inf)
    for approach in range(len(query.axes)):
        for place in range(len(places)):
            for point in places[place]:
                short = aims_gap(shape, query, point, approach)
                gaps[approach, place] = min(gaps[approach, place], max(short, 0.0))
    bounds = np.array([row.max() for row in gaps])
    order = np.argsort(bounds)
    return Ranking(gaps, bounds, order), Minimax(math.inf, -1, int(order[0]), 0)


@kernel
def minimax(
    shape: ArmShape,
    query: Requirements,
    places: FloatArray,
    directions: FloatArray,
    furthest: float,
    ranking: Ranking,
    so_far: Minimax,
    most: int,
) -> Minimax:
    """Return the worst of several places that are all to be reached in one approach, in the best approach for it.

    Args:
        shape: the arm.
        query: the requirements on each place.
        places: places of the tool, each as seen from several places of the base, shape (p, n, 3).
        directions: unit vectors, shape (m, 3).
        furthest: displacements as long as this no longer matter (m).
        ranking: the order of the approaches.
        so_far: the result for the approaches examined before.
        most: the work after which the search is interrupted, between two approaches, in queries.
    """
    scratch, queries, tested = scratch_for(shape), 0, rooms_tested(query)
    best, best_place, best_approach, examined = so_far
    while examined < len(ranking.order) and best > 0.0:
        if queries + ROOM_QUERIES * (rooms_tested(query) - tested) >= most:
            break
        approach, limit = ranking.order[examined], min(best, furthest)
        if ranking.bounds[approach] >= limit:
            examined = len(ranking.order)
            break
        only = slice(approach, approach + 1)
        alone = Requirements(query.axes[only], query.labels[only], query.comfort, query.room)
        worst, worst_place = 0.0, -1
        for place in np.argsort(-ranking.gaps[approach]):
            if not _is_within_margin(shape, alone, places[place], scratch):
                lines = directions_from(shape, alone, places[place], directions)
                short, _, _, _, made = nearest_comfort(
                    shape, alone, places[place], directions, limit, lines, MANY_QUERIES
                )
                queries += made
                if short > worst:
                    worst, worst_place = short, place
                if worst >= limit:
                    break
        if worst < limit:
            best, best_place, best_approach = worst, worst_place, approach
        examined += 1
    if best <= 0.0:
        examined = len(ranking.order)
    return Minimax(best, best_place, best_approach, examined)


@kernel
def _is_within_margin(shape: ArmShape, query: Requirements, points: FloatArray, scratch: Scratch) -> bool:
    """Return whether a place is within the comfort radius in the first approach, from some place of the base."""
    for point in points:
        aim = aim_of(shape, query, point, 0)
        is_near = comfort_gap(shape, aim, query.comfort) <= 0.0
        if is_near and meets_query(shape, query, aim, 0, query.comfort, scratch)[0]:
            return True
    return False
