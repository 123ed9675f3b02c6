"""Where the base should stand before a move: no end of a fold or drag that a plan could use is left out."""

from dataclasses import replace

import numpy as np
import pytest

from planner import Garment
from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import Point2, Pose2
from planner.planning.edges import Edges
from planner.planning.heuristic import arm_time
from planner.planning.problem import Problem
from planner.primitives import g_drag
from planner.primitives.fold_query import FoldQuery
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.search.a_star import SearchResult, Successors, a_star
from planner.task.task import Task
from tests.builders import fold, garment
from tests.unjudged import Unjudged

EXPANDED_MAX = 100_000

PLACES = [Pose2(-0.6938, 0.16188, -1.63851), Pose2(-0.53, 0.123, -1.653), Pose2(-0.731, 0.213, -1.567)]
"""Placements of a poncho: two with a move in the quickest plan, one without."""


def poncho(placement: Pose2) -> Garment:
    wide, cut, middle = 0.57542, 0.1067, 0.27521
    right: list[Point2] = [(wide - cut, 0.0), (wide, cut), (wide, wide - cut), (wide - cut, wide)]
    outline = (*right, *((wide - x, y) for x, y in reversed(right)))
    folds = (fold((wide, middle), (0.0, middle)), fold((0.3592, wide), (0.3592, middle)))
    return replace(garment(outline, *folds), placement=placement)


def quickest(problem: Problem, *, leaves_out: bool = True) -> SearchResult[State, Step]:
    """Return the quickest path that the cost model allows, whether arms can follow it or not.

    Args:
        problem: the problem.
        leaves_out: whether the search leaves out what it deems useless.
    """
    edges = Edges(problem.context, Unjudged(are_spares_wanted=not leaves_out))

    def leaving(state: State, cost_s: float) -> Successors[State, Step]:
        if not leaves_out:
            edges.begin()
        return edges.leaving(state, cost_s)

    *_, found = a_star(problem.start, leaving, problem.is_goal, arm_time(problem.context), EXPANDED_MAX)
    return found


@pytest.mark.parametrize("placement", PLACES)
def test_no_end_left_out_would_make_a_plan_quicker(placement: Pose2, monkeypatch: pytest.MonkeyPatch) -> None:
    task = Task.of(poncho(placement))
    lean = quickest(Problem.of(task).firm())
    monkeypatch.setattr(FoldQuery, "ends", lambda query, begun, *_: (query.every_end(begun), IMPOSSIBLE))
    monkeypatch.setattr(g_drag, "unbeaten", lambda steps, *_: np.flatnonzero(steps < IMPOSSIBLE).tolist())
    full = quickest(Problem.of(task).firm(), leaves_out=False)
    assert full.expanded > lean.expanded, "else nothing is left out"
    assert lean.cost == pytest.approx(full.cost, abs=1e-6)


def test_fewer_ways_never_have_a_lower_bound() -> None:
    problem = Problem.of(Task.of(poncho(PLACES[0]))).firm()
    narrow = problem.restricted(scene=replace(problem.context.scene, approach_cone_rad=0.5))
    found = quickest(problem)
    assert found.cost <= quickest(narrow).cost + 1e-6
    assert any(edge.action.kind == "move" for edge in found.path), "else no move is tried"
