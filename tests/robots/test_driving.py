"""The least driving with which hands follow their paths, against Dijkstra's search over every single place."""

from dataclasses import dataclass
from itertools import product

import networkx as nx
import numpy as np
import pytest
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, Driving
from planner.geometry.reach_query import ReachQuery
from planner.robots.comfort_reach import ComfortReach
from planner.robots.pr2.reach import APPROACHES
from tests.robots.model import the_pr2

ROBOT = the_pr2()
TORSO_M = 0.29
STEP_M = 0.05
COUNT = 17
AHEAD = np.array([i for i, a in enumerate(APPROACHES) if abs(a.heading_rad) < 1.0])


@dataclass(frozen=True)
class Case:
    """Hands on paths, and the standoffs from which the base may begin."""

    arms: tuple[int, ...]
    paths: NDArray[np.float64]
    approaches: tuple[NDArray[np.int64], ...]
    begun: NDArray[np.int64]

    @property
    def hands(self) -> list[ReachQuery]:
        return [ReachQuery(*hand) for hand in zip(self.arms, self.paths, self.approaches, strict=True)]


def cases(seed: int, count: int, arms: tuple[int, ...] | None = None) -> list[Case]:
    """Return one or two hands that fold a flap, away from the robot or to a side, with free hands or holding on."""
    rng = np.random.default_rng(seed)
    return [_case(rng, arms) for _ in range(count)]


def _case(rng: np.random.Generator, given: tuple[int, ...] | None) -> Case:
    arms = given or tuple(rng.permutation(2)[: rng.integers(1, 3)].tolist())
    turn = np.linspace(0.0, np.pi, 7)
    length, heading = rng.uniform(0.05, 0.35), rng.uniform(-1.0, 1.0)
    x, y = rng.uniform(0.1, 0.6), rng.uniform(-0.2, 0.2)
    along = length * (1.0 - np.cos(turn))
    path = np.stack((x + along * np.cos(heading), y + along * np.sin(heading), 0.81 + length * np.sin(turn)), axis=1)
    beside = np.array([0.0, rng.uniform(0.1, 0.5), 0.0])
    more = np.array([0.0, 0.1, 0.0])
    paths = np.array([path + (beside if arm == 0 else -beside) + (n // 2) * more for n, arm in enumerate(arms)])
    allowed = tuple(rng.permutation(AHEAD)[:4] for _ in arms)
    standoff = int(rng.integers(COUNT))
    begun = np.abs(np.arange(COUNT) - standoff)
    if rng.random() < 0.5:
        begun[begun > 0] = IMPOSSIBLE
    return Case(arms, np.round(paths, 5), allowed, begun)


def asked(reach: ComfortReach, case: Case) -> Driving:
    return reach.following(case.hands)(case.begun)


def comfort(reach: ComfortReach, case: Case) -> list[NDArray[np.bool_]]:
    """Return for each hand whether each approach has each waypoint in comfort from each standoff, by single queries."""
    back = STEP_M * np.arange(COUNT)[:, None] * np.array([1.0, 0.0, 0.0])
    found = []
    for arm, path, allowed in zip(case.arms, case.paths, case.approaches, strict=True):
        places = (path[:, None, :] + back).reshape(-1, 3)
        found.append(reach.from_anywhere(ReachQuery(arm, places, allowed)).reshape(len(allowed), len(path), COUNT))
    return found


def dijkstra(is_good: NDArray[np.bool_], begun: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the least steps to each standoff at the last waypoint; `is_good` has shape (waypoints, COUNT)."""
    graph, last = nx.DiGraph(), len(is_good) - 1
    graph.add_node("start")
    for waypoint, j in zip(*np.nonzero(is_good), strict=True):
        if waypoint == 0 and begun[j] < IMPOSSIBLE:
            graph.add_edge("start", (0, j), weight=int(begun[j]))
        if waypoint < last and is_good[waypoint + 1, j]:
            graph.add_edge((waypoint, j), (waypoint + 1, j), weight=0)
        for beside in (j - 1, j + 1):
            if 0 <= beside < COUNT and is_good[waypoint, beside]:
                graph.add_edge((waypoint, j), (waypoint, beside), weight=1)
    steps = nx.single_source_dijkstra_path_length(graph, "start")
    return np.array([steps.get((last, j), IMPOSSIBLE) for j in range(COUNT)])


def least(reach: ComfortReach, case: Case) -> NDArray[np.int64]:
    """Return the least steps to each end over all combinations of approaches."""
    hands = comfort(reach, case)
    ways = [dijkstra(np.logical_and.reduce(good), case.begun) for good in product(*hands)]
    return np.asarray(np.min(ways, axis=0))


def unbeaten(steps: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the ends that cannot be had in as few steps by driving on from another."""
    beaten = [any(steps[o] + abs(o - e) <= steps[e] for o in range(COUNT) if o != e) for e in range(COUNT)]
    return np.where(beaten, IMPOSSIBLE, steps)


@pytest.mark.parametrize("comfort_m", [0.0, 0.03])
def test_the_steps_are_those_of_the_shortest_way_through_all_places_in_comfort(comfort_m: float) -> None:
    naive, driven = ROBOT.reach(TORSO_M, comfort_m), 0
    for case in cases(1, 60):
        expected = least(naive, case)
        following = ROBOT.reach(TORSO_M, comfort_m).following(case.hands)
        np.testing.assert_array_equal(following(case.begun, wanted="every").steps, expected)
        found = following(case.begun)
        np.testing.assert_array_equal(found.steps, unbeaten(expected))
        assert found.more == IMPOSSIBLE
        driven += 0 < expected.min() < IMPOSSIBLE
    assert driven > 10, "some cases need driving"


def test_three_hands_drive_as_far_as_all_three_need() -> None:
    # Arms of a PR2 stand for those of a robot that has three: no two of them are asked whether they are in each
    # other's way.
    naive, driven = ROBOT.reach(TORSO_M, 0.03), 0
    for case in cases(5, 60, (0, 1, 0)):
        expected = least(naive, case)
        following = ROBOT.reach(TORSO_M, 0.03).following(case.hands)
        np.testing.assert_array_equal(following(case.begun, wanted="every").steps, expected)
        driven += expected.min() < IMPOSSIBLE
    assert 5 < driven < 55


def test_an_answer_can_be_driven_in_its_approaches_from_where_it_says() -> None:
    reach = ROBOT.reach(TORSO_M, 0.03)
    ends = 0
    for case in cases(2, 90):
        found = asked(reach, case)
        hands = comfort(reach, case)
        for end in found.ends:
            ends += 1
            is_good = np.logical_and.reduce([good[n] for good, n in zip(hands, found.choice[:, end], strict=True)])
            alone = np.full(COUNT, IMPOSSIBLE)
            alone[found.first[end]] = case.begun[found.first[end]]
            assert dijkstra(is_good, alone)[end] == found.steps[end]
            chosen = found.approaches(end, case.approaches)
            assert all(a in allowed for a, allowed in zip(chosen, case.approaches, strict=True))
    assert ends > 30


@pytest.mark.parametrize("most", [0, 1, 3, 8])
def test_what_takes_too_many_steps_is_left_for_later_and_announced(most: int) -> None:
    reach = ROBOT.reach(TORSO_M, 0.03)
    for case in cases(3, 60):
        everything = asked(reach, case).steps
        early = reach.following(case.hands)(case.begun, most)
        np.testing.assert_array_equal(early.steps, np.where(everything <= most, everything, IMPOSSIBLE))
        left = everything[(everything > most) & (everything < IMPOSSIBLE)]
        assert early.more > most
        assert early.more <= left.min(initial=IMPOSSIBLE)


def test_just_any_end_is_found_exactly_where_there_is_one() -> None:
    reach, found = ROBOT.reach(TORSO_M, 0.03), []
    for case in cases(4, 60):
        following = reach.following(case.hands)
        found.append(bool(following(case.begun, wanted="any").ends))
        assert found[-1] == bool(asked(reach, case).ends)
    assert 10 < sum(found) < 50


def test_the_best_approaches_are_taken_where_the_base_need_not_drive() -> None:
    """Straight ahead, 30 degrees down, a short fold half a metre ahead: any approach will do, so the first is taken."""
    turn = np.linspace(0.0, np.pi, 7)
    path = np.stack((0.55 + 0.05 * (1.0 - np.cos(turn)), 0.2 + 0.0 * turn, 0.85 + 0.05 * np.sin(turn)), axis=1)
    natural = [i for i, a in enumerate(APPROACHES) if a.heading_rad == 0.0 and not a.is_vertical]
    reach, begun = ROBOT.reach(TORSO_M, 0.0), np.abs(np.arange(COUNT))
    for first in natural:
        allowed = np.array([first, *(other for other in natural if other != first)])
        found = reach.following([ReachQuery(0, path, allowed)])(begun)
        assert found.ends == [0] and found.steps[0] == 0
        assert found.approaches(0, (allowed,)) == (first,)


def test_what_other_plans_have_asked_is_answered_and_charged_as_if_nobody_had() -> None:
    some, others = cases(31, 12), cases(32, 12)
    fresh = ROBOT.reach(TORSO_M, 0.03, is_passing=True)
    expected = [asked(fresh, case) for case in some]
    before = ROBOT.reach(TORSO_M, 0.03)
    for case in (*others, *some):
        asked(before, case)
    before.memory.forget()
    again = ROBOT.reach(TORSO_M, 0.03)
    assert again.memory.queries == 0
    for case, driving in zip(some, expected, strict=True):
        np.testing.assert_array_equal(asked(again, case).steps, driving.steps)
    assert again.memory.queries == fresh.memory.queries > 0
