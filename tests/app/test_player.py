import time

import pytest

from app.document import Document
from app.player import UPDATES_PER_S, Player
from planner import Plan, Scene, load_garment, make_plan


class CountingStage:
    """Stands in for a stage, and counts what it is shown."""

    def __init__(self, has_watchers: bool) -> None:
        self.has_watchers = has_watchers
        self.lying, self.plans = 0, 0
        self.times: list[float] = []
        self.themes: list[bool] = []

    def set_theme(self, *, is_dark: bool) -> None:
        self.themes.append(is_dark)

    def show_garment(self, *_: object) -> None:
        self.lying += 1

    def show_plan(self, _: Plan) -> None:
        self.plans += 1

    def show(self, frame) -> None:
        self.times.append(frame.t_s)


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_garment("hand-towel"))


def until(condition) -> None:
    deadline = time.monotonic() + 10.0
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.005)


def playing_for_a_second(plan: Plan, has_watchers: bool) -> list[float]:
    document, stage = Document(load_garment("hand-towel"), Scene()), CountingStage(has_watchers)
    player = Player(document, stage)
    try:
        until(lambda: stage.lying == 1)
        document.settle(1, plan, "id", plan.timeline())
        until(lambda: stage.times == [0.0])
        document.play()
        until(lambda: document.t_s > 1.0)
        document.pause()
        until(lambda: stage.times[-1] == document.t_s)
        assert stage.plans == 1
        return stage.times
    finally:
        player.close()


def test_a_watched_stage_gets_thirty_updates_a_second(plan: Plan) -> None:
    assert 0.6 * UPDATES_PER_S <= len(playing_for_a_second(plan, has_watchers=True)) <= 1.2 * UPDATES_PER_S


def test_an_unwatched_stage_gets_few(plan: Plan) -> None:
    assert len(playing_for_a_second(plan, has_watchers=False)) <= 10


def test_a_paused_stage_gets_one_update_for_each_change(plan: Plan) -> None:
    document, stage = Document(load_garment("hand-towel"), Scene()), CountingStage(True)
    player = Player(document, stage)
    try:
        document.settle(1, plan, "id", plan.timeline())
        for t_s in (1.0, 2.0, 3.0):
            document.seek(t_s)
            until(lambda t_s=t_s: stage.times and stage.times[-1] == t_s)
        time.sleep(0.2)
        assert len(stage.times) <= 4
    finally:
        player.close()


def test_the_stage_follows_the_theme_and_another_garment_keeps_it() -> None:
    document, stage = Document(load_garment("hand-towel"), Scene()), CountingStage(True)
    player = Player(document, stage)
    try:
        until(lambda: stage.lying == 1)
        document.set_theme(is_dark=True)
        until(lambda: stage.themes == [False, True])
        document.choose(load_garment("t-shirt"))
        until(lambda: stage.lying == 2)
        assert document.state.is_dark
        assert stage.themes == [False, True]
    finally:
        player.close()
