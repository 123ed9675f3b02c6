"""The edges of a state in the search: all successors, except those that are no cheaper than from an earlier state."""

import pytest

from planner.planning.edges import Edges
from planner.planning.heuristic import arm_time
from planner.planning.problem import Problem
from planner.primitives.context import Context
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.search.a_star import DeferredEdges, Edge, Outcome, Successors, a_star
from tests.replay.planned import planned
from tests.unjudged import Unjudged

EXPANDED_MAX = 100_000


def edges_of(context: Context, *, are_spares_wanted: bool = False) -> Edges:
    """Return the edges that the model allows, whether arms can follow them or not."""
    return Edges(context, Unjudged(are_spares_wanted=are_spares_wanted))


@pytest.mark.parametrize("name", [pytest.param("tie", marks=pytest.mark.long), "scarf", "big-towel"])
def test_what_is_left_out_makes_no_plan_dearer(name: str) -> None:
    case = planned(name).found
    problem = Problem.of(case.plan.task)
    start, goal, bound = problem.start, problem.is_goal, arm_time(problem.context)
    edges, whole, left_out = edges_of(problem.context), edges_of(problem.context, are_spares_wanted=True), list[int]()

    def everything(state: State, _cost_s: float) -> list[Edge[State, Step] | DeferredEdges[State, Step]]:
        whole.begin()
        return list(whole.leaving(state, 0.0))

    def some(state: State, cost_s: float) -> list[Edge[State, Step] | DeferredEdges[State, Step]]:
        found = list(edges.leaving(state, cost_s))
        left_out.append(len(everything(state, 0.0)) - len(found))
        return found

    *_, lean = a_star(start, some, goal, bound, EXPANDED_MAX)
    *_, full = a_star(start, everything, goal, bound, EXPANDED_MAX)
    assert lean.outcome is full.outcome is Outcome.SOLVED
    assert lean.cost == pytest.approx(full.cost, abs=1e-9)
    assert max(left_out) > 0, "else nothing is tested"


def test_from_a_standoff_passed_on_the_way_only_the_base_moves_on() -> None:
    case = planned("tie").found
    context = case.context
    edges = edges_of(context)
    near, far = State(0, (0.0, 0.0), 0, 0), State(0, (0.0, 0.0), 0, 4)
    first = kinds_of(edges.leaving(near, 10.0))
    assert kinds_of(edges.leaving(far, 10.0 + context.drive_s(4))) == {"move"}
    edges.begin()
    edges.leaving(near, 10.0)
    assert kinds_of(edges.leaving(far, 10.0 + context.drive_s(4) - 0.01)) == first
    edges.begin()
    assert kinds_of(edges.leaving(far, 10.0 + context.drive_s(4))) == first, "a new search begins"


def kinds_of(found: Successors[State, Step]) -> set[str]:
    """Return the kinds of all steps, with the deferred ones that take time worked out."""
    kinds: set[str] = set()
    waiting = list(found)
    while waiting:
        one = waiting.pop()
        if isinstance(one, Edge):
            kinds.add(one.action.kind)
        else:
            waiting += one.compute()
    return kinds
