"""The heuristic is consistent, and A* with it costs what the search without one costs."""

from collections.abc import Iterator

import pytest

from planner.cloth.garment_files import load_garment
from planner.planning.heuristic import arm_time, zero
from planner.plans import make_plan
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.g_drag import GDrag
from planner.primitives.g_fold import GFold
from planner.primitives.primitive import Primitive, Step
from planner.primitives.state import Held, State
from planner.search.a_star import Edge, Outcome, a_star
from tests.builders import context, fold, garment, rectangle_points
from tests.replay.planned import planned, shipped_plan
from tests.required import required
from tests.sweep import sweep

NINE = ("t-shirt", "jeans", "shirt", "tie", "scarf", "vest", "skirt", "big-towel", "hand-towel")


def test_it_counts_three_motions_a_blue_fold_two_a_red_one_and_one_less_while_dragged() -> None:
    blue, red = fold((0.4, 0.12), (0.0, 0.12)), fold((0.0, 0.2), (0.4, 0.2), "red")
    towel = garment(rectangle_points(0.4, 0.3), blue, red)
    bound = arm_time(context(towel))
    assert bound(State(0b00, (0.0, 0.0), 0, 0)) == 9.0 + 6.0
    assert bound(State(0b00, (0.0, 0.0), 0, 0, (Held(0, (0.0, 0.0)),), dragged=1)) == 6.0 + 6.0
    assert bound(State(0b01, (0.0, 0.0), 0, 0, (Held(0, (0.0, 0.24)),))) == 6.0
    assert bound(State(0b11, (0.0, 0.0), 0, 0)) == 0.0
    assert zero(context(towel))(State(0, (0.0, 0.0), 0, 0)) == 0.0


@sweep("name", NINE, ("jeans", "vest", "hand-towel"))
def test_no_edge_lowers_the_bound_by_more_than_it_costs(name: str) -> None:
    case = planned(name)
    problem: Context = case.found.context
    kinds: list[Primitive] = [GFold(problem), GDrag(problem), BaseMove(problem)]
    bound, goal = arm_time(problem), (1 << len(problem.sequence.folds)) - 1
    start = State(0, (0.0, 0.0), 0, 0)

    def successors(state: State, _cost_s: float) -> Iterator[Edge[State, Step]]:
        for kind in kinds:
            for step in kind.successors(state):
                assert bound(state) <= step.duration_s + bound(step.after) + 1e-9, step.details
                yield Edge(step, step.duration_s, step.after)

    *_, found = a_star(start, successors, lambda s: s.done == goal, bound, 100_000)
    assert found.outcome is Outcome.SOLVED
    assert found.cost <= required(case.found.plan.cost_s) + 1e-6, "joint paths only ever take longer"


@sweep("name", NINE, ("jeans", "vest", "hand-towel"))
def test_without_a_heuristic_the_plan_costs_the_same(name: str) -> None:
    blind = make_plan(load_garment(name), heuristic="zero", time_limit_s=60.0)
    assert blind.status == "solved"
    assert blind.cost_s == pytest.approx(shipped_plan(name).cost_s, abs=1e-6)
    assert blind.statistics.expanded >= shipped_plan(name).statistics.expanded
