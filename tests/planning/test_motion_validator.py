"""Joint paths made lazily: the plan costs what a search finds that makes every run real at once, and no way is real
that something stands in."""

import heapq
import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import count
from typing import Any

import numpy as np
import pytest

from planner import Garment, Plan, Scene, Task, find_plan, load_garment
from planner.cloth.garment import DrawnFold
from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table
from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import duration_s
from planner.motion.transfer import Transfer
from planner.motion.transfer_candidate import QUICK
from planner.motion.transfer_planner import TransferPlanner
from planner.planning import motion_validator as validator
from planner.planning import path_search, plan_search, problem
from planner.planning.budget import Budget
from planner.planning.problem import Problem
from planner.primitives.context import Context
from planner.primitives.primitive import Step
from planner.primitives.primitive_set import PRIMITIVES
from planner.primitives.state import State
from planner.robots.collision.collisions import Clearance, Collisions, Contact
from planner.robots.load_robot import load_robot
from planner.robots.pr2.robot import Pr2
from planner.task.reason import Code
from tests.builders import fold, garment, rectangle_points
from tests.planning.found import found_plan
from tests.required import required

BACK = -math.pi / 2
STATIONS = (("front", Pose2(-0.95, 0.0, 0.0)), ("side", Pose2(-0.45, 0.64, BACK)))

HALF = fold((0.3, 0.15), (0.0, 0.15), name="half")
QUARTER = fold((0.15, 0.15), (0.15, 0.3), name="quarter")
OVER, BACK_OVER = fold((0.3, 0.12), (0.0, 0.12), name="over"), fold((0.0, 0.2), (0.3, 0.2), "red", name="back")
IDLE_S = 3.0
"""The time of an arm motion that is long enough for the joints (s)."""

HURRIED_S = 0.3
"""The time of an arm motion that is too short (s): transfers take longer than they seem, and the order may change."""

ROOM_TO_TURN_M = 0.35
"""A standoff that lets the base drive round the table, and the cloth be dragged (m)."""


def napkin(*folds: DrawnFold, x_m: float = -0.6) -> Garment:
    """Return a napkin of 0.3 x 0.3 m, its near edge at x = `x_m`."""
    return garment(rectangle_points(0.3, 0.3), *folds, placement=Pose2(x_m, 0.15, BACK))


def scene(arm_motion_s: float, back_off_max_m: float = 0.05) -> Scene:
    return Scene(stations=STATIONS, back_off_max_m=back_off_max_m, arm_motion_s=arm_motion_s)


def planned(cloth: Garment, where: Scene, *, with_reasons: bool = True) -> Plan:
    return find_plan(Task.of(cloth, where, time_limit_s=60.0), with_reasons=with_reasons).plan


class Eager:
    """Dijkstra's search over all that was done so far, with every transfer and every transit planned at once.

    What a transit takes depends on the transfer before it and on the moves since, so these are part of a node.
    """

    def __init__(self, context: Context) -> None:
        self._kinds = [kind(context) for kind in PRIMITIVES]
        self._maker = TransferPlanner(context, load_robot("pr2"))
        self._goal = (1 << len(context.sequence.folds)) - 1

    def cost_s(self, start: State) -> float:
        numbers, closed = count(), set()
        queue: list[tuple[float, int, State, Transfer | None, tuple[Step, ...]]] = [
            (0.0, next(numbers), start, None, ())
        ]
        while queue:
            cost_s, _, state, before, moves = heapq.heappop(queue)
            if state.done == self._goal:
                return cost_s
            node = (state, before and before.transfer_path, tuple(step.before.key for step in moves))
            if node in closed:
                continue
            closed.add(node)
            for run in self._runs(state, ()):
                if not any(step.grips for step in run):
                    took_s = sum(step.duration_s for step in run)
                    heapq.heappush(queue, (cost_s + took_s, next(numbers), run[-1].after, before, (*moves, *run)))
                elif (real := self._maker.validated(run)) is not None:
                    transit = self._maker.transit(before, moves, real)
                    took_s = sum(real.durations_s()) + (0.0 if transit is None else transit.late_s)
                    heapq.heappush(queue, (cost_s + took_s, next(numbers), run[-1].after, real, ()))
        return math.inf

    def _runs(self, state: State, so_far: tuple[Step, ...]) -> Iterator[tuple[Step, ...]]:
        """Yield all that can be done in a state until the hands are free again."""
        for kind in self._kinds:
            for step in kind.successors(state):
                run = (*so_far, step)
                yield from self._runs(step.after, run) if step.after.held else (run,)


@pytest.mark.parametrize("arm_motion_s", [IDLE_S, HURRIED_S])
@pytest.mark.parametrize(
    ("folds", "back_off_max_m"),
    [
        ((HALF,), 0.05),
        pytest.param((HALF,), ROOM_TO_TURN_M, marks=pytest.mark.long),
        ((HALF, QUARTER), 0.05),
        ((OVER, BACK_OVER), 0.05),
    ],
)
def test_a_plan_costs_what_the_search_finds_that_makes_every_run_real_at_once(
    monkeypatch: pytest.MonkeyPatch, folds: tuple[DrawnFold, ...], back_off_max_m: float, arm_motion_s: float
) -> None:
    # Both try the same ways for each run: tighter tasks, in which others come first that may be quicker, are left out,
    # and so are other ways to which hands come sooner, or that are quicker than a slow one, and more tries.
    for name in ("with_arms_apart", "with_more_comfort", "with_narrower_cones"):
        monkeypatch.setattr(plan_search, name, lambda problem: ())
    monkeypatch.setattr(plan_search, "WORTH_THOROUGH", 1.0)
    monkeypatch.setattr(validator.MotionValidator, "_alternatives", lambda *_: ())
    monkeypatch.setattr(validator.MotionValidator, "_go_beside", lambda *_: False)
    monkeypatch.setattr(EdgeHands, "ways", lambda *_: iter(()))  # such hands may be quicker too
    found = found_plan(napkin(*folds), scene(arm_motion_s, back_off_max_m), time_limit_s=60.0)
    plan, seeming_s = (
        found.plan,
        sum(step.duration_s for plan_segment in found.plan_segments for step in plan_segment.steps),
    )
    assert (required(plan.cost_s) > seeming_s + 0.01) == (arm_motion_s == HURRIED_S), "else nothing is to be found out"
    assert plan.cost_s == pytest.approx(duration_s(found.plan_segments), abs=1e-6)
    assert plan.cost_s == pytest.approx(Eager(found.context).cost_s(found.context.start), abs=1e-6)


IsBarred = Callable[[int, Pose2], bool]
"""A function of an arm's index and a base pose: whether the arm collides there whatever it does."""


class BarredCollisions:
    """Collisions with added obstacles."""

    def __init__(self, real: Collisions, is_barred: IsBarred) -> None:
        self._real = real
        self._is_barred = is_barred

    def is_path_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        return self._real.is_path_free(bases, joints)

    def arm_free(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        stands = [bases] * len(joints) if isinstance(bases, Pose2) else [Pose2(*base) for base in bases]
        is_open = np.array([not self._is_barred(arm, stand) for stand in stands], dtype=bool)
        return is_open & self._real.arm_free(arm, bases, joints)

    def is_arm_path_free(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        return self._real.is_arm_path_free(arm, bases, joints)  # also asked about arms that stay at home

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        return self._real.arms_apart(arms, joints)

    def postures_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> BoolArray:
        return self._real.postures_apart(arms, first, second)

    def are_some_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> bool:
        return self._real.are_some_apart(arms, first, second)

    def over_cloth(self, pieces: Sequence[FloatArray], over_m: float) -> Clearance:
        return self._real.over_cloth(pieces, over_m)

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        return self._real.deepest_contact(base_in_table, joints)


class BarredRobot(Pr2):
    """A PR2 with an obstacle that its reach ignores."""

    def __init__(self, is_barred: IsBarred) -> None:
        super().__init__()
        self._is_barred = is_barred

    def collisions(  # type: ignore[override]
        self, table: Table, torso_m: float, *args: float, **options: float
    ) -> BarredCollisions:
        return BarredCollisions(super().collisions(table, torso_m, *args, **options), self._is_barred)


def barred(monkeypatch: pytest.MonkeyPatch, is_barred: IsBarred) -> None:
    robot = BarredRobot(is_barred)
    monkeypatch.setattr(problem, "load_robot", lambda name: robot)


@pytest.mark.long
def test_an_arm_that_is_barred_at_one_station_makes_the_plan_use_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    # To turn, the base must be 0.47 m away from the table; it stands 0.15 m from it.
    open_way = planned(napkin(HALF), scene(IDLE_S, ROOM_TO_TURN_M))
    assert {p.base.station for p in open_way.primitives} == {"front"}
    barred(monkeypatch, lambda arm, base: base.x_m < -0.9)
    plan = planned(napkin(HALF), scene(IDLE_S, ROOM_TO_TURN_M))
    assert plan.is_solved and required(plan.cost_s) > required(open_way.cost_s)
    (folding,) = (p for p in plan.primitives if p.kind == "fold")
    assert folding.base.station == "side"


def test_an_arm_that_is_barred_where_it_stands_first_makes_the_base_back_off(monkeypatch: pytest.MonkeyPatch) -> None:
    # Barred at the station itself only: it backs off by a step of 0.05 m, at 0.25 m/s.
    barred(monkeypatch, lambda arm, base: abs(base.x_m + 0.95) < 0.01 and base.y_m == 0.0)
    plan = planned(napkin(HALF), scene(IDLE_S))
    assert plan.cost_s == pytest.approx(9.0 + 0.05 / 0.25)
    (folding,) = plan.primitives
    assert folding.base.back_off_m == pytest.approx(0.05)


def test_what_one_arm_cannot_do_the_other_does(monkeypatch: pytest.MonkeyPatch) -> None:
    # One grip holds a corner, at x = -0.3, y = -0.15, 0.65 m ahead of the base.
    corner = fold((0.2, 0.3), (0.3, 0.2), name="corner")
    cloth = napkin(corner)
    (first,) = (p for p in planned(cloth, scene(IDLE_S)).primitives if p.kind == "fold")
    (grip,) = first.grips
    number = ("left", "right").index(grip.arm)
    barred(monkeypatch, lambda arm, base: arm == number)
    plan = planned(cloth, scene(IDLE_S))
    assert plan.is_solved
    assert {g.arm for p in plan.primitives for g in p.grips} == {"left", "right"} - {grip.arm}


@pytest.mark.parametrize("back_off_max_m", [0.0, pytest.param(0.1, marks=pytest.mark.long)])
def test_where_an_arm_is_barred_everywhere_the_reason_is_a_collision(
    monkeypatch: pytest.MonkeyPatch, back_off_max_m: float
) -> None:
    barred(monkeypatch, lambda arm, base: arm == 0)
    plan = planned(napkin(HALF, QUARTER), scene(IDLE_S, back_off_max_m))
    assert plan.status == "infeasible"
    assert (plan.reasons[0].fold, plan.reasons[0].code) == (0, Code.COLLISION)
    assert "cannot get them there" in plan.reasons[0].message


def give_up_after(monkeypatch: pytest.MonkeyPatch, failures: int) -> None:
    for search, name in ((path_search, "QUICK"), (plan_search, "THOROUGH")):
        monkeypatch.setattr(search, name, replace(getattr(search, name), failures=failures))


def test_what_the_same_arms_fail_at_again_and_again_they_try_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    validators = []

    class Seen(validator.MotionValidator):
        def __init__(self, *given: Any) -> None:
            super().__init__(*given)
            validators.append(self)

    monkeypatch.setattr(path_search, "MotionValidator", Seen)
    barred(monkeypatch, lambda arm, base: arm == 0)
    searches = []
    for failures_max in (1, 3):
        give_up_after(monkeypatch, failures_max)
        begun = len(validators)
        plan = planned(napkin(HALF), replace(scene(IDLE_S, 0.1), stations=STATIONS[:1]), with_reasons=False)
        assert plan.status == "infeasible"
        searches.append(validators[begun])
    few, many = (Counter(run[-1].task for run in seen.rejected) for seen in searches)
    assert set(few.values()) == {1}, "after one failure they do not try with the cloth elsewhere"
    assert max(many.values()) > 1


def test_what_the_arms_have_failed_at_from_one_station_they_try_from_another(monkeypatch: pytest.MonkeyPatch) -> None:
    give_up_after(monkeypatch, 1)
    barred(monkeypatch, lambda arm, base: base.x_m < -0.9)
    assert planned(napkin(HALF), scene(IDLE_S, ROOM_TO_TURN_M)).is_solved


@pytest.mark.long
def test_a_fold_whose_hands_hold_on_is_to_blame_for_the_red_one_that_waits_for_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    barred(monkeypatch, lambda arm, base: True)
    plan = planned(napkin(OVER, BACK_OVER), scene(IDLE_S))
    assert plan.status == "infeasible"
    assert [(r.fold, r.code) for r in plan.reasons] == [(0, Code.COLLISION), (1, Code.WAITS_FOR_FOLD)]


def test_where_another_way_is_as_good_the_rest_are_found_only_once_a_path_takes_longer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = found_plan(napkin(HALF), scene(IDLE_S, ROOM_TO_TURN_M))
    problem, (step,) = Problem.of(found.plan.task), found.plan_segments[0].steps
    maker, start = problem.maker, problem.start
    made = maker.made
    monkeypatch.setattr(maker, "made", lambda one: None if one.steps[-1].motion == step.motion else made(one))
    seen = validator.MotionValidator(maker, Budget.endless(), replace(QUICK, ways=1))
    assert seen.plan_segments([step]) is None
    ((other, cost_s),) = seen.possible(start, [step])
    assert other.motion != step.motion and other.after.key == step.after.key and cost_s == step.duration_s
    assert not seen.catch_up(cost_s), "nothing that waits makes a path quicker than this"
    assert seen.catch_up(cost_s + 0.2)
    more = [way.motion for way, _ in seen.possible(start, [step])]
    assert other.motion in more and len(more) > 1
    assert not seen.catch_up(math.inf), "nothing is left that waits"


def test_a_shirt_costs_no_more_where_the_base_may_back_off_further() -> None:
    # With .15 m the last fold's quickest way fails; with .8 m it succeeds, but takes longer than it seemed to.
    shirt = load_garment("shirt")
    costs = [
        required(find_plan(Task.of(shirt, replace(Scene(), back_off_max_m=most_m)), with_reasons=False).plan.cost_s)
        for most_m in (0.15, 0.8)
    ]
    assert costs[1] <= costs[0] + 1e-6
