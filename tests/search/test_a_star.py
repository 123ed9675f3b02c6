"""A* on problems without cloth: a number line, and random graphs against Dijkstra's search."""

import math
import random
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from typing import TypeVar

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.search.a_star import DeferredEdges, Edge, Outcome, SearchResult, a_star

S = TypeVar("S", bound=Hashable)
A = TypeVar("A")


def search(
    start: S,
    successors: Callable[[S], Iterable[Edge[S, A]]],
    goal: S,
    heuristic: Callable[[S], float] = lambda state: 0.0,
    max_expanded: int = 10_000,
    limit: float = math.inf,
) -> SearchResult[S, A]:
    *_, found = paused(start, successors, goal, heuristic, max_expanded, limit)
    return found


def paused(
    start: S,
    successors: Callable[[S], Iterable[Edge[S, A]]],
    goal: S,
    heuristic: Callable[[S], float] = lambda state: 0.0,
    max_expanded: int = 10_000,
    limit: float = math.inf,
) -> Iterator[SearchResult[S, A]]:
    return a_star(
        start, lambda state, cost: successors(state), lambda state: state == goal, heuristic, max_expanded, limit
    )


def number_line(n: int) -> list[Edge[int, int]]:
    """Return successors on a number line: one step up or down costs 1, five steps up cost 3."""
    return [Edge(1, 1.0, n + 1), Edge(-1, 1.0, n - 1), Edge(5, 3.0, n + 5)]


def test_on_a_number_line_the_cheapest_steps_are_found() -> None:
    # 9 = 5 + 5 - 1: 3 + 3 + 1 = 7; by ones after the first five it would be 3 + 4 = 7 too; all by ones 9.
    found = search(0, number_line, 9, lambda n: 0.6 * max(0, 9 - n))
    assert found.outcome is Outcome.SOLVED
    assert found.cost == pytest.approx(7.0)
    assert sum(edge.action for edge in found.path) == 9
    assert found.bound == found.cost


def test_where_the_start_is_the_goal_there_is_nothing_to_do() -> None:
    found = search(3, number_line, 3)
    assert (found.outcome, found.path, found.cost, found.expanded) == (Outcome.SOLVED, (), 0.0, 0)


def test_a_path_leads_from_the_start_to_the_goal() -> None:
    found = search(0, number_line, 13)
    at = 0
    for edge in found.path:
        at += edge.action
        assert edge.after == at
    assert at == 13


def test_an_exhausted_space_is_a_proof() -> None:
    found = search(0, lambda n: [Edge("up", 1.0, n + 1)] if n < 5 else [], 7)
    assert found.outcome is Outcome.INFEASIBLE
    assert found.path == () and found.cost == float("inf")
    assert found.expanded == 6 and found.explored == 5


def test_a_budget_of_expansions_ends_the_search_with_a_bound() -> None:
    found = search(0, number_line, 1000, max_expanded=10)
    assert found.outcome is Outcome.BUDGET_EXCEEDED
    assert found.expanded == 10 and found.path == ()
    assert 0.0 < found.bound <= 600.0


def test_ways_that_cost_as_much_as_the_limit_or_more_are_as_good_as_none() -> None:
    assert search(0, number_line, 9, limit=7.0).outcome is Outcome.INFEASIBLE
    assert search(0, number_line, 9, limit=7.1).cost == pytest.approx(7.0)
    # Below 3 there are the numbers that two single steps lead to; none of the line's ends is needed to end the search.
    assert search(0, number_line, 9, limit=3.0).expanded == len({-2, -1, 0, 1, 2})


def test_a_budget_that_just_suffices_suffices() -> None:
    needed = search(0, number_line, 9).expanded
    assert search(0, number_line, 9, max_expanded=needed).outcome is Outcome.SOLVED
    assert search(0, number_line, 9, max_expanded=needed - 1).outcome is Outcome.BUDGET_EXCEEDED


def test_it_pauses_before_each_expansion_and_says_what_is_known_by_then() -> None:
    asked: list[int] = []

    def successors(n: int) -> list[Edge[int, int]]:
        asked.append(n)
        return number_line(n)

    *pauses, end = paused(0, successors, 9, lambda n: 0.6 * max(0, 9 - n))
    assert {pause.outcome for pause in pauses} == {Outcome.UNFINISHED}
    assert [pause.expanded for pause in pauses] == [*range(end.expanded)]
    assert all(pause.bound <= end.cost for pause in pauses)
    asked.clear()
    assert next(paused(0, successors, 9)).expanded == 0 and asked == [], "nobody needs what nobody takes"


def test_a_sum_in_another_order_is_no_better_path() -> None:
    # 0.1 + 0.2 + 0.3 and 0.3 + 0.2 + 0.1 differ in their last digit: the first found is kept.
    edges: dict[str, list[Edge[str, str]]] = {
        "s": [Edge("up", 0.1, "a"), Edge("down", 0.3, "x")],
        "a": [Edge("up", 0.2, "b")],
        "b": [Edge("up", 0.3, "g")],
        "x": [Edge("down", 0.2, "y")],
        "y": [Edge("down", 0.1, "g")],
        "g": [],
    }
    assert search("s", edges.__getitem__, "g").cost == pytest.approx(0.6)


def test_of_equal_estimates_the_larger_cost_so_far_goes_first() -> None:
    # Two ways of cost 2 with a perfect heuristic: the search runs down one of them without looking at the other.
    edges: dict[str, list[str]] = {"s": ["a", "x"], "a": ["b"], "x": ["y"], "b": ["g"], "y": ["g"], "g": []}
    left = {"s": 3.0, "a": 2.0, "x": 2.0, "b": 1.0, "y": 1.0, "g": 0.0}
    found = search("s", lambda s: [Edge(t, 1.0, t) for t in edges[s]], "g", left.__getitem__)
    assert found.expanded == 3
    assert [edge.action for edge in found.path] == ["a", "b", "g"]


def grid(size: int) -> Callable[[tuple[int, int]], list[Edge[tuple[int, int], str]]]:
    def successors(at: tuple[int, int]) -> list[Edge[tuple[int, int], str]]:
        x, y = at
        steps = [("right", x + 1, y), ("up", x, y + 1)]
        return [Edge(name, 1.0, (u, v)) for name, u, v in steps if u < size and v < size]

    return successors


def test_ties_are_broken_the_same_way_every_time() -> None:
    paths = {tuple(e.action for e in search((0, 0), grid(6), (5, 5)).path) for _ in range(5)}
    assert len(paths) == 1


def random_graph(seed: int) -> nx.DiGraph:
    rng = random.Random(seed)
    graph = nx.gnp_random_graph(25, 0.15, seed=seed, directed=True)
    for a, b in graph.edges:
        graph.edges[a, b]["weight"] = rng.choice([0.0, 1.0, 1.5, rng.uniform(0.0, 3.0)])
    return graph


@given(st.integers(0, 100_000))
def test_random_graphs_cost_what_dijkstra_finds(seed: int) -> None:
    graph = random_graph(seed)

    def successors(node: int) -> list[Edge[int, int]]:
        return [Edge(b, data["weight"], b) for _, b, data in graph.out_edges(node, data=True)]

    exact = nx.single_source_dijkstra_path_length(graph.reverse(), 24)
    blind = search(0, successors, 24)
    # Two thirds of the true rest, 0 where there is no way: consistent, for no edge leads from there to anywhere else.
    led = search(0, successors, 24, lambda node: 2.0 / 3.0 * exact.get(node, 0.0))
    for found in (blind, led):
        if 0 in exact:
            assert found.cost == pytest.approx(exact[0], abs=1e-6)
            assert sum(edge.cost for edge in found.path) == pytest.approx(exact[0], abs=1e-6)
        else:
            assert found.outcome is Outcome.INFEASIBLE


@given(st.integers(0, 100_000))
def test_no_state_is_expanded_twice(seed: int) -> None:
    graph, asked = random_graph(seed), list[int]()

    def successors(node: int) -> list[Edge[int, int]]:
        asked.append(node)
        return [Edge(b, data["weight"], b) for _, b, data in graph.out_edges(node, data=True)]

    found = search(0, successors, 24)
    assert len(asked) == len(set(asked)) == found.expanded


def test_a_state_left_before_is_left_again_if_a_deferred_edge_leads_there_at_less_cost() -> None:
    # The edge to b takes 1, but is deferred until 5, since from b on 4 more are needed than the heuristic says.
    ways: dict[str, Sequence[Edge[str, str] | DeferredEdges[str, str]]] = {
        "a": [Edge("late", 2.0, "b"), DeferredEdges(5.0, "b", lambda: [Edge("soon", 1.0, "b")])],
        "b": [Edge("on", 4.5, "goal")],
    }
    *_, found = a_star("a", lambda at, _: ways.get(at, []), "goal".__eq__, lambda _: 0.0, 100)
    assert [edge.action for edge in found.path] == ["soon", "on"]
    assert found.cost == found.bound == 5.5
