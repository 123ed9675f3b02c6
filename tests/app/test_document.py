from collections.abc import Callable
from dataclasses import dataclass, replace

import pytest

from app.api.live_messages import plan_message, status_text
from app.document import Document, EndedDocumentError
from app.drawing.draft import Draft, draft_of
from app.drawing.drawing import Drawing
from app.drawing.edit import Edit, Phase, StaleVersionError
from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.held_folds import FoldChecks
from planner import Plan, load_garment, make_plan
from planner.cloth.garment import Garment
from tests.app.drawing.drawings import outlined, pulled
from tests.app.samples import towel


@dataclass
class HandClock:
    now_s: float = 0.0

    def __call__(self) -> float:
        return self.now_s


TOWEL = draft_of(drawing_of(Garment.from_dict(towel())))
SPOILT = outlined(TOWEL.drawing)


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(Garment.from_dict(towel()))


@pytest.fixture(scope="module")
def no_plan(plan: Plan) -> Plan:
    return replace(plan, status="infeasible", steps=(), trajectory=None)


def document(clock: HandClock | None = None) -> Document:
    return Document(TOWEL, clock=clock or HandClock())


def moved(millimetres: int) -> Drawing:
    return solve(pulled(TOWEL.drawing, 0, -0.001 * millimetres, 0.0)).drawing


def answer(document: Document, plan: Plan) -> None:
    task = document.state.task
    assert task is not None
    document.settle(document.state.version, task, plan, "id")


def answered(plan: Plan, clock: HandClock | None = None) -> Document:
    made = document(clock)
    answer(made, plan)
    return made


def test_a_new_document_wants_a_plan() -> None:
    state = document().state
    assert state.is_planning
    assert status_text(state) == "Planning..."


def test_the_status_says_how_many_primitives_and_seconds(plan: Plan) -> None:
    text = status_text(answered(plan).state)
    count = len(plan.primitives)
    assert text == f"Planned: {count} step{'' if count == 1 else 's'}, {plan.cost_s:.1f} s"


def test_every_change_is_a_new_version_and_what_changes_nothing_is_none() -> None:
    changed = document()
    assert changed.edit(Edit("Move", moved(1))).version == 2
    assert changed.edit(Edit("Move", moved(1))).version == 2
    assert changed.undo().version == 3
    assert changed.undo().version == 3
    assert changed.redo().version == 4


def test_a_change_of_another_version_is_refused_and_changes_nothing() -> None:
    changed = document()
    changed.edit(Edit("Move", moved(1)))
    many: tuple[Callable[[], object], ...] = (
        lambda: changed.edit(Edit("Move", moved(2), base_version=1)),
        lambda: changed.undo(1),
    )
    for late in many:
        with pytest.raises(StaleVersionError):
            late()
    assert changed.state.drawing == moved(1)
    assert changed.edit(Edit("Move", moved(2), base_version=2)).drawing == moved(2)


def test_while_planning_the_plan_before_stays_and_says_so(plan: Plan) -> None:
    changed = answered(plan)
    changed.edit(Edit("Move", moved(1)))
    message = plan_message(changed.state)
    assert message["status"] == "planning"
    assert message["version"] == 2
    assert message["plan"]["version"] == 1
    assert message["plan"]["is_stale"] is True


def test_an_answer_to_an_older_task_is_shown_only_if_it_is_newer_than_what_is_shown(plan: Plan, no_plan: Plan) -> None:
    changed = document()
    first = changed.state.task
    assert first is not None
    second = changed.edit(Edit("Move", moved(1))).task
    assert second is not None
    changed.edit(Edit("Move", moved(2)))
    changed.settle(2, second, plan, "second")
    assert changed.state.answer is not None
    assert (changed.state.answer.version, changed.state.is_planning) == (2, True)
    for late in (replace(plan), no_plan):
        changed.settle(1, first, late, "first")
        assert changed.state.answer.plan_id == "second"
        assert changed.state.shown is not None and changed.state.shown.plan is plan
        assert changed.state.playback.duration_s == plan.cost_s


def test_the_same_drawing_again_has_the_same_plan_at_once(plan: Plan) -> None:
    """A commit of what was previewed last, or a title: what is to be planned is what was planned."""
    changed = document()
    changed.edit(Edit("Move", moved(1), Phase.PREVIEW))
    answer(changed, plan)
    state = changed.edit(Edit("Move", moved(1), Phase.COMMIT))
    assert state.version == 3
    assert state.answer is not None and state.answer.version == 3
    assert state.shown is not None and state.shown.version == 3
    assert not state.is_planning


def test_with_something_wrong_there_is_no_plan_and_with_it_fixed_the_old_one_is_back(plan: Plan) -> None:
    changed = answered(plan)
    state = changed.edit(Edit("Spoil", SPOILT))
    assert plan_message(state)["plan"] is None
    assert status_text(state).startswith("No plan: outline: has no points")
    assert not state.is_planning
    assert changed.undo().is_answered


def test_the_plan_of_another_garment_is_not_shown_meanwhile(plan: Plan) -> None:
    changed = answered(plan)
    state = changed.edit(Edit("Open", drawing_of(load_garment("tie"))))
    assert plan_message(state)["plan"] is None
    assert state.playback.duration_s == 0.0


def test_the_plan_before_is_the_last_one_of_another_committed_drawing(plan: Plan) -> None:
    changed = answered(plan)
    changed.edit(Edit("Move", moved(1), Phase.PREVIEW))
    answer(changed, plan)
    meanwhile = changed.state
    assert meanwhile.before is None
    changed.edit(Edit("Move", moved(2), Phase.PREVIEW))
    changed.edit(Edit("Move", moved(2), Phase.COMMIT))
    answer(changed, plan)
    assert changed.state.before is not None
    assert changed.state.before.version == 1


def test_checks_of_another_drawing_are_dropped() -> None:
    changed = document()
    changed.put_checks(moved(1), ())
    assert changed.state.checks is None
    changed.put_checks(TOWEL.drawing, ())
    assert changed.state.checks == FoldChecks(1, ())


def test_checks_of_a_preview_are_those_of_its_commit() -> None:
    changed = document()
    changed.edit(Edit("Move", moved(1), Phase.PREVIEW))
    changed.edit(Edit("Move", moved(1), Phase.COMMIT))
    changed.put_checks(moved(1), ())
    assert changed.state.checks == FoldChecks(3, ())


def test_with_an_answer_comes_its_film_and_with_one_that_is_no_plan_it_goes(plan: Plan, no_plan: Plan) -> None:
    changed = document()
    heard: list[tuple[bool, bool]] = []
    changed.subscribe(lambda: heard.append((changed.state.is_answered, changed.state.shown is not None)))
    answer(changed, plan)
    assert heard == [(True, True)], "in one change, so that nobody sees the one without the other"
    shown = changed.state.shown
    assert shown is not None and (shown.version, shown.plan, shown.timeline.duration_s) == (1, plan, plan.cost_s)
    assert changed.state.playback.duration_s == plan.cost_s
    changed.edit(Edit("Move", moved(1)))
    answer(changed, no_plan)
    assert changed.state.shown is None
    assert changed.state.playback.duration_s == 0.0


def test_an_answer_that_comes_when_something_is_wrong_by_now_is_not_played(plan: Plan) -> None:
    changed = document()
    task = changed.state.task
    assert task is not None
    changed.edit(Edit("Spoil", SPOILT))
    changed.settle(1, task, plan, "id")
    assert changed.state.answer is not None and changed.state.answer.plan is plan
    assert changed.state.shown is None
    assert changed.state.playback.duration_s == 0.0


def test_with_what_was_wrong_fixed_the_old_plan_is_played_again(plan: Plan) -> None:
    changed = answered(plan)
    assert changed.edit(Edit("Spoil", SPOILT)).shown is None
    shown = changed.undo().shown
    assert shown is not None and (shown.version, shown.plan) == (3, plan)
    assert changed.state.playback.duration_s == plan.cost_s


def test_a_failure_is_told_as_a_sentence_until_the_next_change() -> None:
    failed = document()
    failed.fail(2, "of another version")
    assert failed.state.failure is None
    failed.fail(1, "the planner failed")
    assert status_text(failed.state) == "No plan: the planner failed"
    assert failed.edit(Edit("Move", moved(1))).is_planning


def test_the_time_stays_when_the_plan_changes(plan: Plan, no_plan: Plan) -> None:
    changed = answered(plan)
    changed.seek(3.0)
    changed.edit(Edit("Move", moved(1)))
    answer(changed, plan)
    assert changed.t_s == 3.0
    changed.edit(Edit("Move", moved(2)))
    answer(changed, no_plan)
    assert changed.t_s == 0.0
    changed.edit(Edit("Move", moved(3)))
    answer(changed, plan)
    assert changed.t_s == 3.0


def test_playing_goes_by_the_wall_clock_and_stops_at_the_end(plan: Plan) -> None:
    clock = HandClock()
    played = answered(plan, clock)
    played.play()
    clock.now_s = 2.0
    assert played.t_s == 2.0
    played.stop_at_end()
    playback = played.state.playback
    assert playback.is_playing
    clock.now_s = 1e4
    played.stop_at_end()
    assert not played.state.playback.is_playing
    assert played.t_s == plan.cost_s


def test_listeners_hear_of_every_change_until_they_leave() -> None:
    heard = []
    watched = document()
    leave = watched.subscribe(lambda: heard.append(watched.state.version))
    watched.edit(Edit("Move", moved(1)))
    watched.undo()
    leave()
    watched.redo()
    assert heard == [2, 3]


def test_a_change_is_kept_before_anybody_sees_it() -> None:
    kept: list[tuple[int, Draft, int]] = []
    watched = Document(TOWEL, keep=lambda version, draft: kept.append((version, draft, watched.state.version)))
    watched.edit(Edit("Move", moved(1)))
    assert [(version, seen) for version, _, seen in kept] == [(2, 1)]
    assert kept[0][1].drawing == moved(1)


def test_a_change_that_cannot_be_kept_is_not_made() -> None:
    def refuse(*_: object) -> None:
        raise OSError("the disk is full")

    watched = Document(TOWEL, keep=refuse)
    with pytest.raises(OSError, match="full"):
        watched.edit(Edit("Move", moved(1)))
    assert watched.state.version == 1
    assert watched.state.drawing == TOWEL.drawing


def test_an_ended_document_is_changed_no_more() -> None:
    ended = document()
    ended.end()
    with pytest.raises(EndedDocumentError):
        ended.edit(Edit("Move", moved(1)))
