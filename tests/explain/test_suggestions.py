"""Suggestions: the smallest changes that give a plan, each proven by it, within a budget."""

import math
import time
from contextlib import suppress
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from planner import Scene, Task, find_plan, load_garment, make_plan
from planner.errors import FoldError, RequestError
from planner.explain.change import SpentError
from planner.explain.suggestion import Suggestion, SuggestionTrial, narrowed
from planner.explain.suggestion_assumption import comforts
from planner.explain.suggestion_placement import placements
from planner.explain.suggestion_robot import stations
from planner.explain.suggestions import Suggestions, suggestions
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.message import Message
from planner.task.plan import Plan
from planner.task.task import TaskOptions
from tests.builders import fold, garment, rectangle_points
from tests.clocks import slow_machine
from tests.explain.proven_search import FAR, FRONT_ONLY, asked, towel
from tests.planning.provoked import planned_with
from tests.replay.planned import shipped_plan
from tests.small_plan import small_plan


@cache
def unreachable() -> Plan:
    """Return what comes of planning a towel that lies out of reach."""
    return make_plan(towel(FAR), FRONT_ONLY)


@pytest.mark.long
@pytest.mark.parametrize("name", ["tie-halved", "scarf-halved"])
def test_a_garment_that_cannot_be_halved_is_told_to_be_folded_nearer_its_end(name: str) -> None:
    cloth = load_garment(name)
    known = shipped_plan(name)
    found = next(s for s in suggestions(Task.of(cloth, time_limit_s=60.0), plan=known) if s.kind == "fold_line")
    assert f"{found.cost_s:.1f} s" in found.message
    assert "towards the robot" in found.message
    plan = planned_with(found.change, cloth)
    # It was found with a share of the work that a plan by itself may take.
    assert plan.cost_s is not None and plan.cost_s <= found.cost_s + 1e-9 and found.cost_s == found.plan.cost_s


def test_a_garment_out_of_reach_is_told_to_be_moved_where_it_can_be_folded() -> None:
    cloth = towel(FAR)
    assert not unreachable().is_solved
    found = next(
        s for s in suggestions(Task.of(cloth, FRONT_ONLY, work_limit_s=5.0, time_limit_s=60.0)) if s.kind == "placement"
    )
    assert "towards the robot" in found.message
    assert planned_with(found.change, cloth, FRONT_ONLY).cost_s == pytest.approx(found.cost_s, abs=1e-9)


def test_every_suggestion_is_proven_by_its_change_and_there_are_three_of_a_kind_at_most() -> None:
    cloth = towel(FAR)
    found = list(suggestions(Task.of(cloth, FRONT_ONLY, work_limit_s=2.0, time_limit_s=60.0)))
    assert len({s.kind for s in found}) > 1
    for kind in {s.kind for s in found}:
        assert len([s for s in found if s.kind == kind]) <= 3
    for one in found:
        assert planned_with(one.change, cloth, FRONT_ONLY).cost_s == pytest.approx(one.cost_s, abs=1e-9)


def test_a_garment_that_slips_off_the_edge_is_told_to_be_moved_no_further_than_it_must() -> None:
    # Of a strip 1 m long .49 m hang over the near edge; with a friction of .7 no more than .4118 m may.
    line = fold((0.0, 0.75), (0.2, 0.75))
    strip = garment(rectangle_points(0.2, 1.0), line, placement=Pose2(-1.29, 0.1, -math.pi / 2))
    task = Task.of(strip, Scene(friction=0.7), work_limit_s=10.0, time_limit_s=60.0)
    search = suggestions(task)
    found = next(one for one in search if one.kind == "placement")
    assert found.size == pytest.approx(0.08, abs=1e-6)
    assert "8 cm away from the robot" in found.message


def test_the_smallest_change_with_a_plan_is_suggested_and_the_smallest_with_one_as_quick() -> None:
    task = asked(towel())
    trial = SuggestionTrial("size", Message.plain("by"), 0.0, task, task)
    solved = small_plan()
    costs = {4: 20.0, 3: 20.0, 2: 30.0}

    def at(amount: float) -> SuggestionTrial:
        return replace(trial, size=round(amount))

    def plan_of(size: float) -> Plan:
        cost_s = costs.get(round(size))
        last = replace(solved.steps[-1], start_s=0.0, duration_s=cost_s or 0.0)
        return replace(solved, status="infeasible" if cost_s is None else "solved", steps=(last,))

    proof = Suggestion(at(4), plan_of(4), 20.0)
    search, told, sent = narrowed(at, 0.0, 4.0, proof, 1.0), [], None
    with suppress(StopIteration):
        while True:
            wish = search.send(sent)
            sent = plan_of(wish.size) if isinstance(wish, SuggestionTrial) else None
            told += [] if isinstance(wish, SuggestionTrial) else [(wish.size, wish.cost_s)]
    assert told == [(2, 30.0), (3, 20.0)]


def test_a_search_out_of_time_suggests_what_it_has_seen_to_work_and_nothing_else() -> None:
    task = asked(towel())
    trial = SuggestionTrial("size", Message.plain("by"), 4.0, task, task)
    proof = Suggestion(trial, small_plan(), 20.0)
    search = narrowed(lambda amount: replace(trial, size=amount), 0.0, 4.0, proof, 1.0)
    assert next(search) == replace(trial, size=2.0)
    assert search.throw(SpentError()) is proof
    with pytest.raises(StopIteration):
        next(search)
    for unproven in (stations(task), placements(task, None), comforts(task)):
        assert isinstance(next(unproven), SuggestionTrial)
        with pytest.raises((StopIteration, SpentError)):
            unproven.throw(SpentError())


@pytest.mark.long
def test_a_garment_that_can_be_folded_is_told_of_nothing_but_a_better_place() -> None:
    cloth = towel(FAR)
    known = make_plan(cloth)
    assert known.cost_s is not None
    found = list(suggestions(Task.of(cloth, work_limit_s=5.0, time_limit_s=60.0)))
    assert [s.kind for s in found] == ["placement"]
    assert found[0].cost_s < known.cost_s - 1.0


def test_what_is_planned_already_is_not_planned_again() -> None:
    cloth = towel(FAR)
    assert list(suggestions(Task.of(cloth, FRONT_ONLY), plan=unreachable(), should_stop=lambda: True)) == []


def test_a_search_that_is_told_to_stop_does_so_within_a_second() -> None:
    cloth = towel(FAR)
    is_unwanted = False
    found = suggestions(Task.of(cloth, FRONT_ONLY, time_limit_s=60.0), should_stop=lambda: is_unwanted)
    next(found)
    is_unwanted = True
    started = time.perf_counter()
    assert list(found) == []
    assert time.perf_counter() - started < 1.0


@pytest.mark.parametrize("options", [{"time_limit_s": 0.0}, {"start_station": "roof"}, {"heuristic": "magic"}])
def test_a_wrong_option_is_refused_before_the_first_suggestion(options: dict[str, Any]) -> None:
    with pytest.raises(RequestError) as caught:
        suggestions(Task.of(towel(), **options))
    assert caught.value.field == next(iter(options))


def test_an_illegal_fold_is_refused_before_the_first_suggestion() -> None:
    with pytest.raises(FoldError):
        suggestions(Task.of(garment(rectangle_points(0.3, 0.4), fold((1.0, 0.2), (2.0, 0.2)))))


def is_complete(found: Suggestions) -> bool:
    """Return the last answer of a search: whether it is complete."""
    while True:
        try:
            next(found)
        except StopIteration as end:
            return bool(end.value)


def test_a_search_says_whether_it_has_tried_everything() -> None:
    # A single fold, done from where it lies: only better placements are looked for, and the table leaves room for few.
    cloth = towel(Pose2(-0.2, 0.15, -math.pi / 2))
    small = Scene(table=Table(0.5, 0.5), stations=(("front", Pose2(-0.4, 0.0, 0.0)),))
    assert make_plan(cloth, small).is_solved
    assert is_complete(suggestions(Task.of(cloth, small, time_limit_s=60.0)))
    assert not is_complete(suggestions(Task.of(cloth, small, time_limit_s=60.0), should_stop=lambda: True))
    for limits in (TaskOptions(work_limit_s=0.01), TaskOptions(time_limit_s=0.01)):
        assert not is_complete(suggestions(Task.of(towel(FAR), FRONT_ONLY, **limits)))


def test_a_trial_that_was_cut_off_before_its_answer_is_not_taken_for_a_no() -> None:
    # Two folds take two states to expand, so none of the trials comes to an answer.
    once = towel(Pose2(-0.2, 0.15, -math.pi / 2))
    cloth = replace(once, folds=(*once.folds, fold((0.15, 0.2), (0.15, 0.4))))
    small = Scene(table=Table(0.5, 0.5), stations=(("front", Pose2(-0.4, 0.0, 0.0)),))
    known = make_plan(cloth, small)
    cut_off = Task.of(cloth, small, max_expanded=1, time_limit_s=60.0)
    assert find_plan(cut_off, with_reasons=False).plan.status == "budget_exceeded"
    assert not is_complete(suggestions(cut_off, plan=known))


@pytest.mark.long
@pytest.mark.parametrize("work_s", [0.4, 1.0])
def test_on_a_slow_machine_the_same_changes_are_suggested(work_s: float, monkeypatch: pytest.MonkeyPatch) -> None:
    limits = TaskOptions(work_limit_s=work_s, time_limit_s=60.0)
    quick, slowly = (
        [one.to_dict() for one in suggestions(Task.of(towel(FAR), FRONT_ONLY, **limits), should_stop=should_stop)]
        for should_stop in (None, slow_machine(monkeypatch))
    )
    assert slowly == quick != []
