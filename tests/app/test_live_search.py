"""A document's search remembers its answers, not what they were found with, and keeps cloth for the next drawing."""

import gc

import pytest

from app.live_search import LiveSearch
from app.worker.stop import Stop
from bench.in_thread import InThread
from planner import Plan, Task
from planner.primitives.context import Context
from tests.planning.provoked import hammer, strip


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
    search, task = LiveSearch(InThread()), Task.of(hammer(), max_expanded=50)
    *_, first = answer_to(search, task)
    assert not first.is_solved
    assert contexts_of(task) == 0


def test_what_was_planned_is_not_planned_again_and_its_cloth_is_kept_for_the_next_drawing() -> None:
    search, task = LiveSearch(InThread()), Task.of(strip(-0.3, 0.3, 0.1))
    *_, first = answer_to(search, task)
    assert first.is_solved
    (again,) = answer_to(search, task)
    assert again == first  # its figures too, and so the time that its search took
    assert contexts_of(task) >= 1
