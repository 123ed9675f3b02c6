import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Literal

import pytest

import app.player as player_module
from app.document import Document
from app.document_state import shown_robot
from app.drawing.draft import draft_of
from app.drawing.edit import Edit, Phase
from app.drawing.garment_drawing import drawing_of
from app.player import UPDATES_PER_S, Player
from app.rehearsal.trace import RunTrace
from planner import Plan, Scene, load_garment
from planner.geometry.pose import Point2, Pose2
from planner.geometry.table import Table
from planner.motion.timeline import Sample, Timeline
from planner.robots.card import RobotCard
from tests.app.drawing.drawings import outlined, pulled
from tests.patience import wait_until
from tests.replay.planned import shipped_plan
from tests.required import required


class CountingView3D:
    """A fake 3D view that counts what it is shown."""

    def __init__(self, has_watchers: bool) -> None:
        self.has_watchers = has_watchers
        self.is_drawn_by_software = False
        self.lying, self.bare, self.plans = 0, 0, 0
        self.times: list[float] = []
        self.joints: dict[str, float] = {}
        self.done: object = None
        self.themes: list[bool] = []
        self.scenes: list[Scene] = []
        self.robots: list[str] = []

    def set_theme(self, *, is_dark: bool) -> None:
        self.themes.append(is_dark)

    def show_scene(self, scene: Scene) -> None:
        self.scenes.append(scene)

    def show_robot(self, card: RobotCard) -> None:
        self.robots.append(card.name)

    def show_garment(self, *shown: object) -> None:
        self.lying += 1
        self.done = shown[3] if len(shown) > 3 else None

    def show_bare(self, _: Pose2) -> None:
        self.bare += 1

    def show_plan(self, _: Plan) -> None:
        self.plans += 1

    def show(self, frame: Sample, _trace: RunTrace | None = None) -> None:
        self.times.append(frame.t_s)
        self.joints = frame.joints


@pytest.fixture(scope="module")
def plan() -> Plan:
    return shipped_plan("hand-towel")


def towel_document() -> Document:
    return Document(draft_of(drawing_of(load_garment("hand-towel"))))


def answer(document: Document, plan: Plan) -> None:
    task = document.state.task
    assert task is not None
    document.settle(document.state.version, task, plan, "id")


def player_of(document: Document, view: CountingView3D) -> Player:
    return Player(document, view)  # type: ignore[arg-type]


def wait_for_update(document: Document, view: CountingView3D) -> None:
    """Wait until the 3D view has shown all that has changed so far: each update begins with the theme."""
    is_dark = document.state.is_dark
    for other in (not is_dark, is_dark):
        document.set_theme(is_dark=other)
        wait_until(lambda: view.themes[-1] is other)  # noqa: B023


class FailingView3D(CountingView3D):
    """A 3D view that fails sometimes, as one does while a visitor leaves it."""

    def __init__(self, failures: int) -> None:
        super().__init__(has_watchers=True)
        self.failures = failures

    def show_garment(self, *_: object) -> None:
        self.failures -= 1
        if self.failures >= 0:
            raise RuntimeError("a visitor has just left")
        self.lying += 1


def playing_for_a_second(plan: Plan, has_watchers: bool) -> list[float]:
    document, view = towel_document(), CountingView3D(has_watchers)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        answer(document, plan)
        wait_until(lambda: view.times == [0.0])
        document.play()
        wait_until(lambda: document.t_s > 1.0)
        document.pause()
        wait_until(lambda: view.times[-1] == document.t_s)
        assert view.plans == 1
        return view.times
    finally:
        player.close()


def test_a_watched_3d_view_gets_thirty_updates_a_second(plan: Plan) -> None:
    assert 0.6 * UPDATES_PER_S <= len(playing_for_a_second(plan, has_watchers=True)) <= 1.2 * UPDATES_PER_S


def test_arms_go_home_once_the_plan_is_over_and_are_back_where_it_is_shown_again(plan: Plan) -> None:
    document, view, end = towel_document(), CountingView3D(has_watchers=True), required(plan.cost_s)
    home = {name: at for arm in shown_robot("pr2").arms for name, at in zip(arm.joint_names, arm.home, strict=True)}
    player = player_of(document, view)
    try:
        answer(document, plan)
        document.seek(end)
        wait_until(
            lambda: view.joints and all(math.cos(view.joints[name] - at) > 1.0 - 1e-9 for name, at in home.items())
        )
        shown = len(view.times)
        assert set(view.times[1:]) == {end} and shown > 10
        document.seek(end - 0.2)
        wait_until(lambda: view.times[-1] == document.t_s)
        assert view.joints == Timeline.of(plan).at(end - 0.2).joints
        assert len(view.times) <= shown + 2, "once the arms are home nothing moves"
    finally:
        player.close()


def test_an_unwatched_3d_view_gets_few(plan: Plan) -> None:
    assert len(playing_for_a_second(plan, has_watchers=False)) <= 10


def test_a_paused_3d_view_gets_one_update_for_each_change(plan: Plan) -> None:
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        answer(document, plan)
        for t_s in (1.0, 2.0, 3.0):
            document.seek(t_s)

            def is_shown(t_s: float = t_s) -> bool:
                return bool(view.times) and view.times[-1] == t_s

            wait_until(is_shown)
        assert len(view.times) <= 4
        assert player._period_s() is None, "nothing but a change wakes it"
    finally:
        player.close()


def test_the_3d_view_follows_the_theme_and_another_garment_keeps_it() -> None:
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        document.set_theme(is_dark=True)
        wait_until(lambda: view.themes == [False, True])
        document.edit(Edit("Open T-shirt", drawing_of(load_garment("t-shirt"))))
        wait_until(lambda: view.lying == 2)
        assert document.state.is_dark
        assert view.themes == [False, True]
    finally:
        player.close()


def test_the_cloth_follows_the_drawing_at_once_while_the_film_stands_at_its_beginning(plan: Plan) -> None:
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        answer(document, plan)
        wait_until(lambda: view.times == [0.0])
        document.edit(Edit("Move", pulled(document.state.drawing, 0, -0.01, 0.0)))
        wait_until(lambda: view.lying == 2)
        document.undo()
        wait_until(lambda: len(view.times) == 2)
    finally:
        player.close()


@pytest.mark.parametrize(("status", "drawn"), [("solved", (1, 1)), ("infeasible", (2, 0))])
def test_the_3d_view_waits_with_a_drawing_for_its_plan_if_there_is_one(
    status: Literal["solved", "infeasible"], drawn: tuple[int, int], plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(player_module, "PATIENCE_S", 60.0)
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        document.edit(Edit("Move", pulled(document.state.drawing, 0, -0.01, 0.0)))
        answer(document, replace(plan, status=status))
        wait_until(lambda: (view.lying, view.plans) == drawn)
    finally:
        player.close()


def test_in_the_middle_of_a_film_it_stays_until_the_next(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(player_module, "PATIENCE_S", 0.0)
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        answer(document, plan)
        document.seek(2.0)
        wait_until(lambda: view.times and view.times[-1] == 2.0)
        document.edit(Edit("Move", pulled(document.state.drawing, 0, -0.01, 0.0)))
        wait_for_update(document, view)
        assert view.lying == 1
    finally:
        player.close()


def test_a_spoilt_drawing_leaves_in_the_3d_view_what_was_there(plan: Plan) -> None:
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        document.edit(Edit("Spoil", outlined(document.state.drawing, (0.0, 0.0), (0.1, 0.0))))
        wait_for_update(document, view)
        assert (view.lying, view.bare) == (1, 0)
    finally:
        player.close()


def test_where_nothing_is_drawn_the_3d_view_has_no_cloth() -> None:
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        document.edit(Edit("Clear", outlined(document.state.drawing)))
        wait_until(lambda: view.bare == 1)
        document.set_theme(is_dark=True)
        document.undo()
        wait_until(lambda: view.lying == 2)
        assert view.bare == 1
    finally:
        player.close()


@pytest.mark.parametrize("corners", [(), ((0.0, 0.0), (0.1, 0.0))])
def test_a_robot_waits_at_the_table_before_there_is_any_cloth(corners: tuple[Point2, ...]) -> None:
    drawing = drawing_of(load_garment("hand-towel"))
    view = CountingView3D(True)
    player = player_of(Document(draft_of(outlined(drawing, *corners))), view)
    try:
        wait_until(lambda: view.bare == 1)
        assert view.lying == 0
    finally:
        player.close()


def test_another_scene_is_put_up_with_what_is_shown_in_it() -> None:
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        high = replace(Scene(), table=Table(height_m=0.9))
        document.edit(Edit("Table", replace(document.state.drawing, scene=high)))
        wait_until(lambda: view.lying == 2)
        assert view.scenes == [Scene(), high]
    finally:
        player.close()


def test_what_could_not_be_drawn_is_drawn_anew(caplog: pytest.LogCaptureFixture) -> None:
    document, view = towel_document(), FailingView3D(failures=1)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
    finally:
        player.close()
    assert "a visitor has just left" in caplog.text


def test_what_fails_again_waits_for_the_next_change(caplog: pytest.LogCaptureFixture) -> None:
    document, view = towel_document(), FailingView3D(failures=2)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.failures == 0)
        assert view.lying == 0
        document.set_theme(is_dark=True)
        wait_until(lambda: view.lying == 1)
    finally:
        player.close()
    assert caplog.text.count("the 3D view could not be brought up to date") == 2


def drag_on(document: Document, dx_m: float) -> None:
    drawing = pulled(document.state.drawing, 0, dx_m, 0.0)
    document.edit(Edit("Move", drawing, Phase.PREVIEW, gesture="one"))


def test_where_software_draws_it_the_3d_view_follows_a_hand_once_that_rests(
    plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(player_module, "PATIENCE_S", 0.0)
    now_s = 0.0
    monkeypatch.setattr(player_module, "time", SimpleNamespace(monotonic=lambda: now_s))
    document, view = towel_document(), CountingView3D(True)
    view.is_drawn_by_software = True
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        for _ in range(3):
            drag_on(document, -0.001)
            wait_for_update(document, view)
            now_s += 0.9 * player_module.REST_S
            wait_for_update(document, view)
            assert view.lying == 1
        now_s += 0.2 * player_module.REST_S
        wait_until(lambda: view.lying == 2)  # the hand rests
        drag_on(document, -0.001)
        wait_for_update(document, view)
        assert view.lying == 2
        document.edit(Edit("Move", document.state.drawing, gesture="one"))
        wait_until(lambda: view.lying == 3)  # the hand has let go
    finally:
        player.close()


def test_where_a_graphics_card_draws_it_the_3d_view_follows_a_hand_at_once(
    plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(player_module, "PATIENCE_S", 0.0)
    monkeypatch.setattr(player_module, "REST_S", 60.0)
    document, view = towel_document(), CountingView3D(True)
    player = player_of(document, view)
    try:
        wait_until(lambda: view.lying == 1)
        for number in (2, 3, 4):
            drag_on(document, -0.001)

            def has_followed(number: int = number) -> bool:
                return view.lying == number

            wait_until(has_followed)
    finally:
        player.close()


def test_a_plan_that_is_pointed_at_is_shown_to_its_end_then_the_own_one_and_without_a_plan_the_cloth_alone(
    plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(player_module, "PREVIEW_S", 0.2)
    document, view = towel_document(), CountingView3D(has_watchers=True)
    answer(document, plan)
    player = player_of(document, view)
    wait_until(lambda: view.times == [0.0])
    document.preview(plan)
    wait_until(lambda: view.times[-1] == plan.cost_s)
    assert view.plans == 2 and document.t_s == 0.0
    document.preview(None)
    wait_until(lambda: view.times[-1] == 0.0)
    document.preview(replace(plan, status="infeasible", steps=(), trajectory=None))
    wait_until(lambda: view.done == set(range(len(plan.garment.folds))))
    player.close()
