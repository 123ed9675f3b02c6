"""A* on anything hashable (paper, section 5.3). It knows no cloth and no robot.

Ties: the larger cost so far first, then the order of insertion, so that the same problem gives the same path on
every run and machine. With a consistent heuristic no state is expanded twice.
"""

import heapq
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import count
from typing import Generic, TypeVar

S = TypeVar("S", bound=Hashable)
A = TypeVar("A")

_DIGITS = 9
"""Costs are compared to this many decimals: sums of the same terms in another order are the same cost."""


class Outcome(StrEnum):
    """How a search ended."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    BUDGET_EXCEEDED = "budget_exceeded"


@dataclass(frozen=True, slots=True)
class Edge(Generic[S, A]):
    """A way from a state to another.

    Attributes:
        action: what is done.
        cost: what it costs, not negative.
        after: the state it leads to.
    """

    action: A
    cost: float
    after: S


@dataclass(frozen=True, slots=True)
class SearchResult(Generic[S, A]):
    """What a search found.

    Attributes:
        outcome: solved, infeasible (all states that can be reached were seen), or out of budget.
        path: the edges from the start to the goal; empty unless solved.
        cost: the path's cost; infinite unless solved.
        bound: no path to a goal costs less than this.
        expanded: states popped and expanded.
        explored: successors pushed.
    """

    outcome: Outcome
    path: tuple[Edge[S, A], ...]
    cost: float
    bound: float
    expanded: int
    explored: int


@dataclass(slots=True)
class _Tree(Generic[S, A]):
    """The states seen, what each costs so far, and the edge that led there."""

    costs: dict[S, float]
    parents: dict[S, tuple[S, Edge[S, A]]] = field(default_factory=dict)
    closed: set[S] = field(default_factory=set)

    def improves(self, state: S, cost: float) -> bool:
        return cost < self.costs.get(state, float("inf"))

    def path_to(self, state: S) -> tuple[Edge[S, A], ...]:
        path: list[Edge[S, A]] = []
        while state in self.parents:
            state, edge = self.parents[state]
            path.append(edge)
        return tuple(reversed(path))


def a_star(
    start: S,
    successors: Callable[[S], Iterable[Edge[S, A]]],
    is_goal: Callable[[S], bool],
    heuristic: Callable[[S], float],
    max_expanded: int,
    should_stop: Callable[[], bool],
) -> SearchResult[S, A]:
    """The cheapest way from a state to a goal.

    Args:
        start: where the search begins.
        successors: the edges that leave a state.
        is_goal: whether a state is a goal.
        heuristic: a consistent lower bound on the cost from a state to a goal.
        max_expanded: the budget in expansions.
        should_stop: asked before each expansion; true ends the search as out of budget.
    """
    tree: _Tree[S, A] = _Tree({start: 0.0})
    numbers = count()
    queue = [(round(heuristic(start), _DIGITS), 0.0, next(numbers), start)]
    expanded = explored = 0
    while queue:
        estimate, minus_cost, _, state = heapq.heappop(queue)
        if state in tree.closed:
            continue
        if is_goal(state):
            return SearchResult(Outcome.SOLVED, tree.path_to(state), -minus_cost, -minus_cost, expanded, explored)
        if expanded >= max_expanded or should_stop():
            return SearchResult(Outcome.BUDGET_EXCEEDED, (), float("inf"), estimate, expanded, explored)
        tree.closed.add(state)
        expanded += 1
        for edge in successors(state):
            cost = round(edge.cost - minus_cost, _DIGITS)
            if edge.after not in tree.closed and tree.improves(edge.after, cost):
                tree.costs[edge.after] = cost
                tree.parents[edge.after] = (state, edge)
                entry = (round(cost + heuristic(edge.after), _DIGITS), -cost, next(numbers), edge.after)
                heapq.heappush(queue, entry)
                explored += 1
    return SearchResult(Outcome.INFEASIBLE, (), float("inf"), float("inf"), expanded, explored)
