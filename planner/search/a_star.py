"""A* on anything hashable (paper, section 5.3). It knows no cloth and no robot.

Successors may be costly to compute, and most of them are never needed: they cost more than the best path. So instead of
edges a state may yield deferred ones (`DeferredEdges`) with a lower bound on their costs. They wait in the queue as an
edge would, and are computed when nothing cheaper is left.

Ties: the larger cost so far first, then the order of insertion, so that the same problem gives the same path on every
run and machine. Deferred edges count with the cost of the state that yielded them, so a known path goes before an
unknown one.

With a consistent heuristic no state is expanded twice, but for one: deferred edges may cost less than their bound, if
what must follow them takes longer than the heuristic says by as much. A state to which such an edge leads at less cost
than before is expanded again.
"""

import heapq
import math
from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import count
from typing import Generic, NamedTuple, TypeAlias, TypeVar

S = TypeVar("S", bound=Hashable)
A = TypeVar("A")

_DIGITS = 9
"""The decimals to which costs are compared, so that sums of the same terms in another order are equal."""


_WORTH_REOPENING = 1e-6
"""The least cost saved for which a state is expanded again: sums of rounded costs differ by less."""


class Outcome(StrEnum):
    """The outcome of a search."""

    UNFINISHED = "unfinished"
    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    BUDGET_EXCEEDED = "budget_exceeded"


class Edge(NamedTuple, Generic[S, A]):
    """An edge from a state to another.

    Attributes:
        action: the action taken.
        cost: its cost, not negative.
        after: the state it leads to.
    """

    action: A
    cost: float
    after: S


class DeferredEdges(NamedTuple, Generic[S, A]):
    """Deferred edges that leave a state.

    Attributes:
        cost: a lower bound on the cost of each, with what must follow it beyond the heuristic.
        towards: a state at which the heuristic is no larger than at any state that they lead to.
        compute: returns them; further deferred edges of the same state may be among them.
    """

    cost: float
    towards: S
    compute: "Callable[[], Iterable[Edge[S, A] | DeferredEdges[S, A]]]"


Successors: TypeAlias = Iterable[Edge[S, A] | DeferredEdges[S, A]]
"""The edges that leave a state, some of them deferred."""


class SearchResult(NamedTuple, Generic[S, A]):
    """The result of a search.

    Attributes:
        outcome: solved, infeasible (all states that can be reached were seen), out of budget, or not finished yet.
        path: the edges from the start to the goal; empty unless solved.
        cost: the path's cost; infinite unless solved.
        bound: a lower bound on the cost of any path to a goal.
        expanded: states popped and expanded.
        explored: successors pushed.
    """

    outcome: Outcome
    path: tuple[Edge[S, A], ...]
    cost: float
    bound: float
    expanded: int
    explored: int


_Entry: TypeAlias = tuple[float, float, int, S, DeferredEdges[S, A] | None]
"""The estimate, the negated cost so far, a number that breaks ties, the state, and its deferred edges or None."""


@dataclass(slots=True)
class _Search(Generic[S, A]):
    """The states seen, their costs so far, the edge that led to each, and the queue."""

    heuristic: Callable[[S], float]
    limit: float
    is_consistent: bool
    costs: dict[S, float] = field(default_factory=dict)
    parents: dict[S, tuple[S, Edge[S, A]]] = field(default_factory=dict)
    closed: set[S] = field(default_factory=set)
    queue: list[_Entry[S, A]] = field(default_factory=list)
    numbers: Iterator[int] = field(default_factory=count)
    explored: int = 0

    def push(self, state: S, cost: float, beyond: float, deferred: DeferredEdges[S, A] | None) -> bool:
        """Queue a state, or deferred edges of one, and return whether it may lead to a goal below the limit."""
        estimate = round(cost + beyond, _DIGITS)
        if estimate >= self.limit:
            return False
        heapq.heappush(self.queue, (estimate, -cost, next(self.numbers), state, deferred))
        return True

    def push_all(self, state: S, cost: float, found: Successors[S, A]) -> None:
        """Queue all edges from a state that was reached at a cost.

        With a consistent heuristic no path through a state is cheaper than the state's own bound, whatever the bound of
        its deferred edges.
        """
        least = self.heuristic(state) if self.is_consistent else 0.0
        for way in found:
            if isinstance(way, DeferredEdges):
                self.push(state, cost, max(least, way.cost + self.heuristic(way.towards)), way)
            else:
                self._follow(state, round(cost + way.cost, _DIGITS), way)

    def _follow(self, state: S, cost: float, edge: Edge[S, A]) -> None:
        after = edge.after
        known = self.costs.get(after, math.inf)
        if after in self.closed:
            known = known - _WORTH_REOPENING if self.is_consistent else -math.inf
        if cost < known and self.push(after, cost, self.heuristic(after), None):
            self.costs[after] = cost
            self.parents[after] = (state, edge)
            self.closed.discard(after)
            self.explored += 1

    def path_to(self, state: S) -> tuple[Edge[S, A], ...]:
        path: list[Edge[S, A]] = []
        while state in self.parents:
            state, edge = self.parents[state]
            path.append(edge)
        return tuple(reversed(path))


def a_star(
    start: S,
    successors: Callable[[S, float], Successors[S, A]],
    is_goal: Callable[[S], bool],
    heuristic: Callable[[S], float],
    max_expanded: int,
    limit: float = math.inf,
    *,
    is_consistent: bool = True,
) -> Iterator[SearchResult[S, A]]:
    """Search the cheapest path from a state to a goal.

    The search pauses before each expansion, and before deferred edges are computed. To stop it, take no more from it.

    Args:
        start: the state at which the search begins.
        successors: returns the edges that leave a state reached at a cost, some of them deferred.
        is_goal: tells whether a state is a goal.
        heuristic: a consistent lower bound on the cost from a state to a goal; infinite where there is no path to one.
        max_expanded: the budget in expansions.
        limit: the cost from which on a path is as good as none.
        is_consistent: whether the heuristic is consistent; a weighted one is not, and the path found may then not be
            the cheapest.

    Yields:
        At each pause what is known by then, an unfinished result; at last the result.
    """
    search: _Search[S, A] = _Search(heuristic, limit, is_consistent, {start: 0.0})
    search.push(start, 0.0, heuristic(start), None)
    expanded, bound = 0, 0.0
    while search.queue:
        estimate, minus_cost, _, state, deferred = heapq.heappop(search.queue)
        # Each estimate popped is a lower bound: deferred edges may have one above that of what they yield.
        cost, bound = -minus_cost, max(bound, estimate)
        if deferred is None and state in search.closed:
            continue
        if deferred is None and is_goal(state):
            yield SearchResult(Outcome.SOLVED, search.path_to(state), cost, cost, expanded, search.explored)
            return
        if deferred is None and expanded >= max_expanded:
            yield SearchResult(Outcome.BUDGET_EXCEEDED, (), math.inf, bound, expanded, search.explored)
            return
        yield SearchResult(Outcome.UNFINISHED, (), math.inf, bound, expanded, search.explored)
        if deferred is None:
            search.closed.add(state)
            expanded += 1
            search.push_all(state, cost, successors(state, cost))
        else:
            search.push_all(state, cost, deferred.compute())
    yield SearchResult(Outcome.INFEASIBLE, (), math.inf, math.inf, expanded, search.explored)
