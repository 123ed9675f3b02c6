"""Quick plans: a plan for the current drawing is shown while the search for the best one goes on."""

import threading
from collections.abc import Iterator
from dataclasses import replace

import pytest

from app import replanner
from app.document_state import VersionPlan
from app.drawing.edit import Edit
from app.drawing.solve import solve
from planner import Task
from planner.planning import plan_search
from planner.planning.events import Done, Event
from planner.plans import plan
from tests.app.drawing.drawings import crease
from tests.app.replan_desk import TOWEL, Desk, Endless, moved, replanning
from tests.patience import PATIENCE_S, wait_until
from tests.required import required

QUARTERED = solve(replace(TOWEL, folds=(*TOWEL.folds, crease("quarter", (0.2, 0.15), (0.2, 0.3))))).drawing


@pytest.fixture
def desk() -> Iterator[Desk]:
    with replanning() as desk:
        yield desk


def test_the_plan_before_is_shown_as_it_is_for_the_drawing_now_while_a_quicker_one_is_looked_for(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.rest()
    may_end = threading.Event()

    def waiting(*arguments: object, **options: object) -> object:
        assert may_end.wait(PATIENCE_S)
        return plan(*arguments, **options)  # type: ignore[arg-type]

    monkeypatch.setattr("app.live_planning.plan", waiting)
    desk.document.edit(Edit("Move", moved(20)))
    wait_until(lambda: desk.is_answered and desk.has_film)
    first = desk.document.state.answer
    assert first is not None and not first.is_final
    assert first.plan.is_solved and first.plan.garment.outline[0] == (-0.02, 0.0)
    may_end.set()
    desk.rest()
    last = desk.document.state.answer
    assert last is not None and last.is_final and last.plan.is_proven
    assert required(last.plan.cost_s) <= required(first.plan.cost_s)


def test_who_stops_the_search_for_a_quicker_plan_keeps_the_one_shown(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.rest()
    endless = Endless(is_once=False)
    monkeypatch.setattr("app.live_planning.plan", endless)
    desk.document.edit(Edit("Move", moved(20)))
    assert endless.begun.wait(PATIENCE_S)
    shown = desk.document.state.answer
    assert shown is not None
    desk.document.stop_planning()
    assert endless.stopped.wait(PATIENCE_S)
    desk.rest()
    assert desk.document.state.failure is None and desk.answer.plan is shown.plan


def test_a_plan_that_was_shown_stays_readable_when_a_quicker_one_takes_its_place(desk: Desk) -> None:
    desk.rest()
    shown: set[str] = set()
    unsubscribe = desk.document.subscribe(lambda: shown.add(desk.answer.plan_id))
    for millimetres in (5, 15):
        desk.document.edit(Edit("Move", moved(millimetres)))
        desk.rest()
    unsubscribe()
    assert len(shown) >= 4, "of each edit the plan before as it is now, and what the search ended with"
    assert all(desk.plans.plan(plan_id).is_solved for plan_id in shown)


def answers(desk: Desk) -> list[VersionPlan]:
    """Record everything that is shown from now on."""
    shown: list[VersionPlan] = []

    def look() -> None:
        state = desk.document.state
        if state.is_answered and (not shown or shown[-1] is not state.answer):
            shown.append(required(state.answer))

    desk.document.subscribe(look)
    return shown


def test_with_another_fold_nothing_much_slower_is_shown_before_the_quickest_plan(desk: Desk) -> None:
    desk.rest()
    shown = answers(desk)
    desk.document.edit(Edit("Draw fold", QUARTERED))
    desk.rest()
    # Where hands come a little late to the second fold, the search looks for another way while this one is shown.
    costs_s = [required(answer.plan.cost_s) for answer in shown]
    assert shown[-1].is_final
    assert costs_s == sorted(costs_s, reverse=True)
    assert costs_s[0] < costs_s[-1] + 0.5


def test_but_in_a_search_that_takes_long_some_plan_is_shown_that_begins_like_the_one_before(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.rest()
    before = desk.answer.plan
    monkeypatch.setattr(plan_search, "GREEDY_AFTER_S", 0.0)
    shown = answers(desk)
    desk.document.edit(Edit("Draw fold", QUARTERED))
    desk.rest()
    assert [answer.is_final for answer in shown] == [False, True]
    meanwhile, last = (answer.plan for answer in shown)
    begins = meanwhile.primitives[: len(before.primitives)]
    assert [(p.kind, p.details) for p in begins] == [(p.kind, p.details) for p in before.steps]
    assert required(last.cost_s) <= required(meanwhile.cost_s)
    assert all(desk.plans.plan(answer.plan_id) == answer.plan for answer in shown)


def test_what_was_not_found_with_little_work_is_found_by_who_looks_longer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.replanner.WORK_S", 1e-4)
    with replanning() as desk:
        wait_until(lambda: desk.is_answered)
        state = desk.document.state
        assert state.answer is not None and state.answer.plan.status == "budget_exceeded" and state.may_look_longer
        desk.document.look_longer()
        assert not desk.document.state.may_look_longer
        desk.rest()
        answer = desk.document.state.answer
        assert answer is not None and answer.plan.is_proven
        desk.document.look_longer()
        assert desk.document.state.answer is answer, "what is proven is not looked for again"


def test_who_looks_longer_keeps_the_plan_on_show_until_a_quicker_one_is_found(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unproven(task: Task, *given: object, **options: object) -> Iterator[Event]:
        for event in plan(task, *given, **options):  # type: ignore[arg-type]
            if isinstance(event, Done) and required(task.limits.work_limit_s) <= replanner.WORK_S:
                found = event.found
                statistics = replace(found.plan.statistics, bound_s=1.0, is_cut_short=True)
                yield Done(replace(found, plan=replace(found.plan, statistics=statistics)))
            else:
                yield event

    monkeypatch.setattr("app.live_planning.plan", unproven)
    desk.rest()
    desk.document.edit(Edit("Move", moved(20)))
    desk.rest()
    shown = desk.document.state.answer
    assert shown is not None and shown.plan.is_solved and desk.document.state.may_look_longer
    noted = answers(desk)
    desk.document.look_longer()
    desk.rest()
    assert [(answer.is_final, answer.plan.is_proven) for answer in noted] == [(False, False), (True, True)]
    assert noted[0].plan is shown.plan


def test_that_there_is_no_plan_is_told_before_the_reasons_are_tried(desk: Desk) -> None:
    """Reasons that were met come at once, marked as not tried; then those that were."""
    desk.rest()
    seen: list[VersionPlan] = []

    def look() -> None:
        answer = desk.document.state.answer
        if answer is not None and desk.is_answered and not any(answer is one for one in seen):
            seen.append(answer)

    desk.document.subscribe(look)
    far = replace(TOWEL, placement=replace(TOWEL.placement, x_m=0.4))
    alone = replace(far.scene, stations=far.scene.stations[:1], back_off_max_m=0.0)
    desk.document.edit(Edit("Lay far away", solve(replace(far, scene=alone)).drawing))
    wait_until(lambda: desk.is_answered and desk.answer.is_final)
    first, last = seen[0], seen[-1]
    assert not first.is_final and first.plan.status == "infeasible"
    assert first.plan.reasons and all(reason.set is None for reason in first.plan.reasons)
    assert last.is_final and any(reason.set is not None for reason in last.plan.reasons)
