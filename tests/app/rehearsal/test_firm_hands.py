"""A second hand where one would hold cloth loosely, in rehearsals in which the robot looks."""

import math
from dataclasses import replace
from functools import cache

import pytest

from app.rehearsal import perform
from app.rehearsal.judge import Gate
from app.rehearsal.perform import FIRM_S, Performance, Performer
from app.rehearsal.rest import FIRM, is_loose, rest_tasks
from app.rehearsal.world import Observation, Performed, StepMotion
from planner import Plan, Task, load_garment, make_plan
from planner.geometry.ring import evenly_along


@cache
def hand_towel() -> Plan:
    """Return the plan of a towel of which two folds are left, the first with corners 10.5 cm from its one hand."""
    plan = make_plan(Task.of(load_garment("hand-towel")))
    return make_plan(replace(plan.task, start=plan.steps[0].after))


class FirstStep:
    """A world in which the cloth lies a centimetre beside its place before the first step and is gone after it."""

    def __init__(self, plan: Plan) -> None:
        before = plan.steps[0].before
        self.asked: list[StepMotion] = []
        lies = replace(before.placement, x_m=before.placement.x_m + 0.01)
        self._outline = evenly_along(lies.to_outer(plan.sequence.cloth(before.done).silhouette.ring), 0.005)

    def observe(self) -> Observation:
        return Observation() if self.asked else Observation(outline=self._outline)

    def perform(self, motion: StepMotion) -> Performed:
        self.asked.append(motion)
        return Performed({grip.arm: True for grip in motion.grips})

    def truth(self) -> None:
        return


def begun(answer: Plan | None = None) -> tuple[list[StepMotion], Performance, list[Task]]:
    """Perform the plan; return the motions asked for, what became of it, and the tasks that were planned."""
    planned: list[Task] = []

    def replan(task: Task) -> Plan:
        planned.append(task)
        return make_plan(task) if answer is None else answer

    world = FirstStep(hand_towel())
    done = Performer(hand_towel(), world, Gate(), replan).performed()
    return world.asked, done, planned


def furthest_m(plan: Plan, step: int) -> float:
    """Return how far a vertex is from the grip that holds it in a step, at most (m)."""
    return max(math.dist(one.point, vertex) for one in plan.steps[step].holdings for vertex in one.vertices)


def test_a_second_hand_takes_what_one_would_hold_loosely():
    assert len(hand_towel().steps[0].holdings) == 1
    assert furthest_m(hand_towel(), 0) == pytest.approx(0.10475, abs=1e-5)  # the edge is 20.95 cm wide
    asked, done, planned = begun()
    first = done.decisions[1]
    assert (done.decisions[0].code, first.code) == ("seen", "firmer")
    assert 0.0 < dict(first.numbers)["longer_s"] < FIRM_S
    assert len(asked[0].grips) == 2
    assert planned[0].garment.folds[1].grip_radius_m == pytest.approx(FIRM * 0.127)
    assert planned[0].start == hand_towel().steps[0].before, "as planned: it is corrected by where the cloth lies"
    assert [one.code for one in done.decisions[2:4]] == ["seen", "corrected"]


def test_where_that_takes_longer_or_cannot_be_one_hand_does_it(monkeypatch: pytest.MonkeyPatch):
    asked, done, planned = begun(replace(hand_towel(), status="infeasible", steps=()))
    assert len(asked[0].grips) == 1 and planned
    assert [one.code for one in done.decisions[:2]] == ["seen", "corrected"]
    monkeypatch.setattr(perform, "FIRM_S", 0.0)
    asked, done, _ = begun()
    assert len(asked[0].grips) == 1
    assert [one.code for one in done.decisions[:2]] == ["seen", "corrected"]


def test_without_feedback_hands_are_those_of_the_plan():
    world = FirstStep(hand_towel())
    Performer(hand_towel(), world, Gate()).performed()
    assert [len(motion.grips) for motion in world.asked] == [len(step.holdings) for step in hand_towel().steps]


def test_what_is_loose_is_told_by_the_radius_of_the_task_as_it_was_at_first():
    step, task = hand_towel().steps[0], hand_towel().task
    firm = make_plan(rest_tasks(task, step.before)[0])
    assert is_loose(step, task)
    assert not any(is_loose(one, task) for one in firm.steps)
    assert not is_loose(step, replace(task, robot="ur5e-single"))  # of one arm


def test_where_some_corners_can_only_be_held_loosely_the_others_are_held_firmly():
    # Of a vest's first fold one hand must hold two corners 10.5 cm away; it could hold those of its hem, 12.7 cm away.
    plan = make_plan(Task.of(load_garment("vest")))
    firmest, firm, loose = rest_tasks(plan.task, plan.task.start)
    assert not make_plan(firmest).is_solved
    assert [len(step.holdings) for step in make_plan(firm).steps] == [2, 2]
    assert loose.garment == plan.garment
