"""A search remembers answers for all documents, not what they were found with, and keeps cloth for the next drawing."""

import gc
from dataclasses import replace
from typing import Any

import pytest

from app.files.slowed import slowed
from app.live_planning import Found
from app.live_search import LiveSearch
from app.store.packed_plan import Answers, PackedPlan
from app.worker.stop import Stop
from bench.in_thread import InThread
from planner import Plan, Task
from planner.primitives.context import Context
from tests.planning.provoked import hammer, strip
from tests.small_plan import small_plan, unsolved


def answer_to(search: LiveSearch, task: Task) -> list[Plan]:
    """Return the plans that a search shows, the final one last."""
    told: list[Plan] = []

    def show(plan: Plan, *, is_final: bool) -> None:
        told.append(plan)

    search.find(task, None, 10.0, show, lambda: None, Stop())
    return told


def contexts_of(task: Task) -> int:
    gc.collect()
    return sum(isinstance(one, Context) and one.sequence.garment == task.garment for one in gc.get_objects())


@pytest.mark.long
def test_a_no_is_remembered_without_what_it_was_found_with() -> None:
    search, task = LiveSearch(InThread(), Answers()), Task.of(hammer(), max_expanded=50)
    *_, first = answer_to(search, task)
    assert not first.is_solved
    assert contexts_of(task) == 0


def test_what_was_planned_is_not_planned_again_and_its_cloth_is_kept_for_the_next_drawing() -> None:
    search, task = LiveSearch(InThread(), Answers()), Task.of(strip(-0.3, 0.3, 0.1))
    *_, first = answer_to(search, task)
    assert first.is_solved
    (again,) = answer_to(search, task)
    assert again == first  # its figures too, and so the time that its search took
    assert contexts_of(task) >= 1


class Idle(InThread):
    """A worker that nothing may be asked of."""

    def run_for(self, key: str, work: Any, *_: Any, **_named: Any) -> Any:
        raise AssertionError(f"{work} was asked for")


def test_what_one_document_was_answered_another_need_not_have_planned_until_the_robot_is_another() -> None:
    answers, task = Answers(), Task.of(strip(-0.3, 0.3, 0.1))
    answers.add(task, PackedPlan.of(small_plan()))
    (again,) = answer_to(LiveSearch(Idle(), answers), task)
    assert again.cost_s == small_plan().cost_s
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("app.store.packed_plan.robot_stamp", lambda _: (0, 0, 0))
        with pytest.raises(AssertionError, match="was asked for"):
            answer_to(LiveSearch(Idle(), answers), task)


def test_the_answer_asked_for_least_recently_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.store.packed_plan._ANSWERS_MAX", 2)
    answers, packed = Answers(), PackedPlan.of(small_plan())
    first, second, third = (Task.of(strip(-0.3, 0.3, 0.1 + 0.01 * number)) for number in range(3))
    for task in (first, second):
        answers.add(task, packed)
    assert answers.get(first) is not None
    answers.add(third, packed)
    assert [answers.get(task) is None for task in (first, second, third)] == [False, True, False]


class Finding(InThread):
    """A worker that finds one plan, at once."""

    def __init__(self, plan: Plan) -> None:
        super().__init__()
        self._plan = plan

    def run_for(self, key: str, work: Any, stop: Any, on_news: Any, *_: Any, **_named: Any) -> Any:
        on_news(Found(self._plan, "name", is_final=True))


def test_a_document_that_takes_a_proposal_shows_its_plan_until_a_search_has_its_answer() -> None:
    task, quick = Task.of(strip(-0.3, 0.3, 0.1), work_limit_s=3.0), small_plan()
    for found, proposed in ((slowed(quick, 0.5), quick), (quick, slowed(quick, 0.5))):
        answers = Answers()
        answers.propose(Task.of(strip(-0.3, 0.3, 0.1)), PackedPlan.of(proposed))
        assert answer_to(LiveSearch(Finding(found), answers), task) == [proposed, found]
        (other,) = answer_to(LiveSearch(Finding(found), answers), Task.of(strip(-0.3, 0.3, 0.11)))
        assert other is found


def test_where_a_search_finds_no_plan_a_document_keeps_that_of_its_proposal() -> None:
    answers, task, none = Answers(), Task.of(strip(-0.3, 0.3, 0.1)), replace(unsolved(), status="budget_exceeded")
    answers.propose(task, PackedPlan.of(small_plan()))
    first, last = answer_to(LiveSearch(Finding(none), answers), task)
    assert first == small_plan() and last.cost_s == first.cost_s
    assert not last.is_proven
