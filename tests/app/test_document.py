from dataclasses import dataclass

import pytest

from app.api.live_messages import status_text
from app.document import Document
from planner import Plan, Scene, load_garment, make_plan


@dataclass
class HandClock:
    now_s: float = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_garment("hand-towel"))


def document(clock: HandClock | None = None) -> Document:
    return Document(load_garment("hand-towel"), Scene(), clock or HandClock())


def settled(plan: Plan, clock: HandClock) -> Document:
    settled = document(clock)
    settled.settle(1, plan, "id", plan.timeline())
    return settled


def test_a_new_document_wants_a_plan() -> None:
    state = document().state
    assert state.is_planning
    assert status_text(state) == "Planning..."


def test_an_answer_for_an_older_version_is_dropped(plan: Plan) -> None:
    changed = document()
    changed.choose(load_garment("tie"))
    changed.settle(1, plan, "id", plan.timeline())
    assert changed.state.plan is None
    assert changed.state.version == 2


def test_the_status_says_how_many_primitives_and_seconds(plan: Plan) -> None:
    text = status_text(settled(plan, HandClock()).state)
    assert text == f"Planned: {len(plan.primitives)} primitives, {plan.cost_s:.1f} s"


def test_choosing_a_garment_forgets_plan_and_time_but_not_the_speed(plan: Plan) -> None:
    changed = settled(plan, HandClock())
    changed.set_speed(4.0)
    changed.seek(3.0)
    changed.choose(load_garment("tie"))
    assert changed.state.plan is None
    assert changed.t_s == 0.0
    assert changed.state.playback.speed == 4.0


def test_playing_goes_by_the_wall_clock_and_stops_at_the_end(plan: Plan) -> None:
    clock = HandClock()
    played = settled(plan, clock)
    played.play()
    clock.now_s = 2.0
    assert played.t_s == 2.0
    played.stop_at_end()
    assert played.state.playback.is_playing
    clock.now_s = 1e4
    played.stop_at_end()
    assert not played.state.playback.is_playing
    assert played.t_s == plan.cost_s


def test_listeners_hear_of_every_change_until_they_leave(plan: Plan) -> None:
    heard = []
    watched = document()
    leave = watched.subscribe(lambda: heard.append(watched.state.version))
    watched.choose(load_garment("tie"))
    watched.settle(2, plan, "id", plan.timeline())
    leave()
    watched.play()
    assert heard == [2, 2]


def test_a_failure_is_told_as_a_sentence() -> None:
    failed = document()
    failed.fail(1, "folds[0].start: off the cloth")
    assert status_text(failed.state) == "No plan: folds[0].start: off the cloth"
    assert not failed.state.is_planning
