"""The cache of transit paths: it is kept from plan to plan, and a path is searched for once."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from planner import Task, load_garment
from planner.motion.transit_paths import TransitPaths
from planner.planning.problem import Problem
from planner.primitives.g_fold import GFold
from planner.primitives.state import State
from planner.robots.card import OPENING_M
from tests.required import required


def test_a_transit_path_is_searched_for_once_and_known_to_the_next_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    free = TransitPaths._is_free

    def noted(self: TransitPaths, *about: Any) -> bool:
        asked.append(about)
        return free(self, *about)

    monkeypatch.setattr(TransitPaths, "_is_free", noted)

    def led() -> object:
        problem = Problem.of(Task.of(load_garment("hand-towel")))
        fold = next(step for step in GFold(problem.context).successors(problem.start))
        made = problem.maker.validated((fold,))
        assert made is not None
        return made.approach.shortest_s, made.retreat.shortest_s

    first = led()
    count = len(asked)
    assert led() == first and len(asked) == count


@pytest.fixture
def searched(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """Return what paths are searched for, the known ones left out."""
    asked: list[object] = []
    search = TransitPaths._search

    def noted(self: TransitPaths, wanted: Any) -> Any:
        asked.append(wanted)
        return search(self, wanted)

    monkeypatch.setattr(TransitPaths, "_search", noted)
    return asked


def test_paths_that_differ_in_their_cloth_or_its_room_are_others(searched: list[object]) -> None:
    problem = Problem.of(Task.of(load_garment("hand-towel")))
    transits, base = problem.maker.transits, problem.context.base_pose(0, 0)
    start = transits.home
    goal = start + np.linspace(0.0, 0.2, len(start))
    bare, covered = (problem.maker._cloths.of(state) for state in (problem.start, _far(problem)))
    near = transits.at_grips
    way = required(transits.way(base, start, goal, bare, near))
    assert np.array_equal(required(transits.way(base, start.copy(), goal.copy(), bare, near)), way)
    assert len(searched) <= 1
    searched.clear()
    none = (np.zeros(len(near[0])), near[1])
    transits.way(base, start, goal, bare, none)
    transits.way(base, start, goal, covered, near)
    assert len(searched) == 2


def test_a_path_is_found_again_whole_turns_away_though_turns_are_not_exact(searched: list[object]) -> None:
    problem = Problem.of(Task.of(load_garment("hand-towel")))
    transits, base = problem.maker.transits, problem.context.base_pose(0, 0)
    cloth, near = problem.maker._cloths.of(problem.start), transits.at_grips
    start, goal = transits.home, transits.home + 0.1
    turns = 2.0 * np.pi * transits.layout.is_continuous
    assert turns.any()
    way = required(transits.way(base, start, goal, cloth, near))
    searched.clear()
    for count in (-3, 1, 7):
        turned = required(transits.way(base, start + count * turns, goal + (count + 1) * turns, cloth, near))
        assert np.allclose(turned, way + count * turns, atol=1e-9)
        assert np.array_equal(turned[0], start + count * turns)
    assert searched == []


def test_hands_come_by_the_corners_of_a_similar_transfer_where_these_are_free() -> None:
    problem = Problem.of(Task.of(load_garment("hand-towel")))
    fold = next(step for step in GFold(problem.context).successors(problem.start))
    maker = problem.maker
    made = required(maker.validated((fold,)))
    own = required(made.coming)
    middle, crossed = 0.5 * (own[0] + own[-1]), own[0].copy()
    crossed[[0, 7]] = -0.6, 0.6
    for corner, is_free in ((middle, True), (crossed, False)):
        like = replace(made, coming=np.array([own[0], corner, own[-1]]))
        coming = required(required(maker.made_like(maker.candidate((fold,)), like)).coming)
        expected = required(like.coming) if is_free else own
        assert coming.shape == expected.shape and np.allclose(coming, expected, atol=1e-12)


def _far(problem: Problem) -> State:
    state = problem.start
    return type(state)(state.done, (0.1, 0.0), state.station, state.standoff)


def test_a_motion_beside_a_driving_base_is_tested_once(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = Problem.of(Task.of(load_garment("hand-towel")))
    transits, cloth = problem.maker.transits, problem.maker._cloths.of(problem.start)
    asked: list[object] = []
    are_clear = TransitPaths.are_clear

    def noted(self: TransitPaths, *about: Any) -> bool:
        asked.append(about)
        return are_clear(self, *about)

    monkeypatch.setattr(TransitPaths, "are_clear", noted)
    bases = np.column_stack([np.linspace(-1.2, -1.3, 5), np.zeros(5), np.zeros(5)])
    joints = np.tile(transits.home, (5, 1))
    wide = np.full((5, len(transits.layout.arms)), OPENING_M)
    assert transits.is_clear(cloth, bases, joints, wide)
    assert transits.is_clear(cloth, bases.copy(), joints.copy(), wide.copy()) and len(asked) == 1
    inside = bases + np.array([1.2, 0.0, 0.0])
    assert not transits.is_clear(cloth, inside, joints, wide)
