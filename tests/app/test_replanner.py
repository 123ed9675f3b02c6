"""Plans follow the drawing: the latest wins, and each answer names its version."""

import itertools
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

from app.api.live_messages import plan_message, status_text
from app.document_state import VersionPlan
from app.drawing.edit import Edit, Phase
from app.replanner import Replanner, Searching
from app.store.plan_store import PlanStore, UnknownPlanError
from app.worker.stop import Stop
from planner import Plan
from planner.task.world_state import Holding
from tests.app.drawing.drawings import crease, outlined
from tests.app.replan_desk import TOWEL, Desk, Endless, moved, nothing, replanning
from tests.patience import PATIENCE_S, wait_until


@pytest.fixture
def desk() -> Iterator[Desk]:
    with replanning() as desk:
        yield desk


def near(x_m: float) -> object:
    return pytest.approx(x_m)


def test_the_first_plan_comes_by_itself_with_checks_and_film(desk: Desk) -> None:
    desk.rest()
    state = desk.document.state
    assert state.answer is not None and state.answer.version == 1
    assert desk.plans.plan(state.answer.plan_id) == state.answer.plan
    assert state.checks is not None
    (held,) = state.checks.folds
    assert sorted(held.must_hold) == [pytest.approx((0.0, 0.0)), pytest.approx((0.4, 0.0))]
    assert held.grips_needed == 2


def test_the_grips_that_are_told_are_those_of_the_plan_and_without_one_the_fewest(desk: Desk) -> None:
    desk.rest()
    state = desk.document.state
    answer, checks = state.answer, state.checks
    assert answer is not None and checks is not None
    (step,), (held,) = answer.plan.steps, checks.folds
    more = replace(step, holdings=(*step.holdings, Holding("third", (0.2, 0.3), ())))
    holding_more = replace(state, answer=replace(answer, plan=replace(answer.plan, steps=(more,))))
    unplanned = replace(state, version=2)
    told = [plan_message(one)["checks"]["folds"][0] for one in (holding_more, unplanned)]
    assert [*told[0]["grips"]] == [one.point for one in more.holdings]
    assert told[1]["grips"] == held.grips
    assert [one["grips_needed"] for one in told] == [2, 2]


def test_an_edit_is_planned_and_the_plan_is_of_what_is_drawn(desk: Desk) -> None:
    desk.rest()
    desk.document.edit(Edit("Move", moved(20)))
    desk.rest()
    answer = desk.document.state.answer
    assert answer is not None and answer.version == 2
    assert answer.plan.garment.outline[0] == (-0.02, 0.0)


def test_of_many_edits_the_last_is_planned(desk: Desk) -> None:
    for number in range(1, 8):
        desk.document.edit(Edit("Move", moved(number)))
    desk.rest()
    answer = desk.document.state.answer
    assert answer is not None and answer.version == 8
    assert answer.plan.garment.outline[0] == (near(-0.007), 0.0)


def test_while_somebody_drags_plans_of_older_previews_are_shown(desk: Desk) -> None:
    """Previews come faster than plans; each search is given a little time to end all the same."""
    desk.rest()
    shown: set[int] = set()
    millimetres = itertools.count(0.1, 0.1)

    def are_shown_while_it_is_dragged() -> bool:
        desk.document.edit(Edit("Drag", moved(next(millimetres)), Phase.PREVIEW))
        shown.add(desk.answer.version)
        return len(shown) >= 3

    wait_until(are_shown_while_it_is_dragged)
    desk.document.edit(Edit("Drag", moved(30), Phase.COMMIT))
    desk.rest()
    assert desk.answer.plan.garment.outline[0] == (near(-0.03), 0.0)


def test_undo_finds_its_plan_again_at_once(desk: Desk) -> None:
    desk.rest()
    assert desk.document.state.answer is not None
    first = desk.document.state.answer.plan
    desk.document.edit(Edit("Move", moved(20)))
    desk.rest()
    desk.document.undo()
    desk.rest()
    assert desk.document.state.answer.plan == first


def test_a_drawing_that_was_spoilt_and_is_fixed_has_its_plan_and_playback_again(desk: Desk) -> None:
    desk.rest()
    assert desk.document.state.answer is not None
    first = desk.document.state.answer.plan
    one, other, *rest = TOWEL.outline
    state = desk.document.edit(Edit("Spoil", replace(TOWEL, outline=(other, one, *rest))))
    assert state.solution.problems and state.shown is None
    desk.document.edit(Edit("Fix", TOWEL))
    desk.rest()
    assert desk.document.state.answer.plan is first


def test_plans_of_previews_are_not_kept_and_those_of_commits_are(desk: Desk) -> None:
    desk.rest()
    ids = []
    for number in (1, 2, 3):
        desk.document.edit(Edit("Drag", moved(number), Phase.PREVIEW))
        desk.rest()
        assert desk.document.state.answer is not None
        ids.append(desk.document.state.answer.plan_id)
    desk.document.edit(Edit("Drag", moved(3), Phase.COMMIT))
    for plan_id in ids[:2]:
        with pytest.raises(UnknownPlanError):
            desk.plans.plan(plan_id)
    assert desk.answer.plan is desk.plans.plan(ids[2])
    desk.document.edit(Edit("Move", moved(4)))
    desk.rest()
    assert desk.plans.plan(ids[2]).is_solved


def test_the_last_previews_plan_can_still_be_read_when_that_of_the_commit_takes_its_place(desk: Desk) -> None:
    # A page that was told of it a moment ago may ask for it.
    desk.rest()
    desk.document.edit(Edit("Drag", moved(1), Phase.PREVIEW))
    desk.rest()
    assert desk.document.state.answer is not None
    told = desk.document.state.answer.plan_id
    desk.document.edit(Edit("Drag", moved(3), Phase.COMMIT))
    desk.rest()
    assert desk.document.state.answer.plan_id != told
    assert desk.plans.plan(told).is_solved


def test_a_plan_is_shown_before_it_is_written_and_written_only_if_it_is_final(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.rest()
    written: list[tuple[str, VersionPlan | None]] = []

    def write(_: PlanStore, plan_id: str, __: Plan) -> None:
        written.append((plan_id, desk.document.state.answer))

    monkeypatch.setattr(PlanStore, "_write", write)
    desk.document.edit(Edit("Move", moved(20)))
    wait_until(lambda: bool(written))
    desk.rest()
    ((plan_id, shown),) = written
    assert shown is not None and shown.plan_id == plan_id and shown.is_final


def test_what_folds_need_is_told_of_those_before_an_illegal_one_too(desk: Desk) -> None:
    off = crease("off", (0.2, 0.2), (0.3, 0.2))
    state = desk.document.edit(Edit("Draw", replace(TOWEL, folds=(*TOWEL.folds, off))))
    wait_until(lambda: desk.document.state.checks is not None and desk.document.state.checks.version == state.version)
    assert desk.document.state.checks is not None
    assert len(desk.document.state.checks.folds) == 1
    assert not desk.document.state.is_planning


def test_with_nothing_drawn_there_is_nothing_to_plan(desk: Desk) -> None:
    state = desk.document.edit(Edit("Clear", outlined(TOWEL)))
    wait_until(lambda: desk.document.state.checks is not None and desk.document.state.checks.version == state.version)
    assert not desk.document.state.is_answered


def test_a_torso_that_cannot_be_raised_so_far_is_told_of_by_its_field(desk: Desk) -> None:
    desk.document.edit(Edit("Torso", replace(TOWEL, scene=replace(TOWEL.scene, torso_m=0.9))))
    wait_until(lambda: desk.document.state.failure is not None)
    assert status_text(desk.document.state).startswith("No plan: scene.torso_m: 0.9 m")


def test_a_bug_in_the_planner_is_told_of_and_the_next_edit_is_planned(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    desk.rest()

    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr("app.live_planning.plan", fail)
    desk.document.edit(Edit("Move", moved(1)))
    wait_until(lambda: desk.document.state.failure is not None)
    assert status_text(desk.document.state) == "No plan: the planner failed"
    assert "a bug" in caplog.text
    monkeypatch.undo()
    desk.document.edit(Edit("Move", moved(2)))
    desk.rest()


def test_a_committed_edit_stops_the_search_for_the_one_before(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    desk.rest()
    endless = Endless()
    monkeypatch.setattr("app.live_planning.plan", endless)
    desk.document.edit(Edit("Move", moved(1)))
    assert endless.begun.wait(PATIENCE_S)
    desk.document.edit(Edit("Move", moved(2)))
    assert endless.stopped.wait(PATIENCE_S)
    desk.rest()


def test_who_stops_planning_is_told_so_and_the_next_edit_is_planned(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.rest()
    endless = Endless(is_once=False)
    with monkeypatch.context() as patch:
        patch.setattr("app.live_planning.plan", endless)
        patch.setattr("app.live_planning.quick_plan", nothing)
        desk.document.edit(Edit("Move", moved(1)))
        assert endless.begun.wait(PATIENCE_S)
        desk.document.stop_planning()
        assert endless.stopped.wait(PATIENCE_S)
    assert status_text(desk.document.state) == "No plan: planning was stopped; the next change is planned again"
    assert not desk.document.state.is_planning
    desk.document.plan_again()
    desk.rest()
    assert desk.document.state.is_answered
    desk.document.edit(Edit("Move", moved(2)))
    desk.rest()
    desk.document.stop_planning()
    assert desk.document.state.failure is None, "there is nothing to stop any more"
    desk.document.plan_again()
    assert desk.document.state.is_answered, "nor to plan"


def test_a_search_that_takes_long_gives_way_to_the_next_preview(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    desk.rest()
    endless = Endless()
    monkeypatch.setattr("app.live_planning.plan", endless)
    desk.document.edit(Edit("Drag", moved(1), Phase.PREVIEW))
    assert endless.begun.wait(PATIENCE_S)
    desk.document.edit(Edit("Drag", moved(2), Phase.PREVIEW))
    desk.rest()
    assert desk.document.state.answer is not None
    assert desk.document.state.answer.version == 3


def test_who_drags_back_to_what_was_just_given_up_gets_its_plan_all_the_same(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The search for the first preview gives way to the second; before it ends, the first is what is drawn again."""
    desk.rest()
    begun, given_up, go = threading.Event(), threading.Event(), threading.Event()
    plan = Replanner._plan

    def gives_up(self: Replanner, search: Searching, stop: Stop) -> None:
        if given_up.is_set():
            plan(self, search, stop)
            return
        begun.set()
        wait_until(search.stop)
        given_up.set()
        assert go.wait(PATIENCE_S)

    monkeypatch.setattr(Replanner, "_plan", gives_up)
    desk.document.edit(Edit("Drag", moved(1), Phase.PREVIEW))
    assert begun.wait(PATIENCE_S)
    desk.document.edit(Edit("Drag", moved(2), Phase.PREVIEW))
    assert given_up.wait(PATIENCE_S)
    desk.document.edit(Edit("Drag", moved(1), Phase.PREVIEW))
    go.set()
    desk.rest()
    assert desk.document.state.answer is not None
    assert desk.document.state.answer.version == 4


def test_a_robot_whose_arms_must_be_mapped_first_is_told_with_how_far_that_is(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.rest()
    told: list[float | None] = []

    def prepare(robot: str, progress: Callable[[float], None]) -> None:
        for share in (0.25, 0.251, 0.75):
            progress(share)

    monkeypatch.setattr("app.live_planning.prepare_robot", prepare)
    desk.document.subscribe(lambda: told.append(plan_message(desk.document.state)["prepared"]))
    desk.document.edit(Edit("Move", moved(20)))
    desk.rest()
    shares = [share for share in told if share is not None]
    assert shares == [0.25, 0.75]
    assert told[-1] is None
    assert desk.document.state.answer is not None and desk.document.state.answer.version == 2


def test_that_the_planner_is_compiled_first_is_told_until_it_is(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    desk.rest()
    told: list[bool] = []
    monkeypatch.setattr("app.replanner.must_compile", lambda _: True)
    monkeypatch.setattr("app.live_planning.compile_kernels", lambda _: None)
    desk.document.subscribe(lambda: told.append(plan_message(desk.document.state)["is_compiling"]))
    desk.document.edit(Edit("Move", moved(20)))
    desk.rest()
    assert True in told and told[-1] is False
    assert desk.document.state.answer is not None and desk.document.state.answer.version == 2
