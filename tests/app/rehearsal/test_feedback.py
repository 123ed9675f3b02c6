"""Feedback in a world that only notes what it is asked for: cloth that lies elsewhere, and hands that miss."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.corrections import SHORT_M, beside_grips, carried_along, regrasps
from app.rehearsal.finger_ends import reach_ahead
from app.rehearsal.judge import Gate, carry
from app.rehearsal.noise import Noise
from app.rehearsal.noisy_world import NoisyWorld
from app.rehearsal.perform import FAILURES_MAX, Performer, rest_task
from app.rehearsal.step_motions import step_motions
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.world import WITHDRAW, Observation, Performed, StepMotion
from planner import Plan, Task, make_plan
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.robots.load_robot import load_robot, robot_card_file
from planner.task.task import TIME_LIMIT_S
from tests.app.rehearsal.flat_cloth import home
from tests.app.rehearsal.towel import towel_plan
from tests.builders import evenly_along
from tests.replay.planned import shipped_plan


class NotedWorld:
    """Cloth that lies somewhere, flat, out of sight once it is folded, and hands that miss as often as told."""

    def __init__(self, outline: FloatArray, misses: int = 0, *, shows_folded: bool = False) -> None:
        self.asked: list[StepMotion] = []
        self._outline, self._misses, self._shows_folded = outline, misses, shows_folded

    def observe(self) -> Observation:
        has_folded = len(self.asked) > self._misses and any(motion.is_fold for motion in self.asked)
        is_folded = has_folded and not self._shows_folded
        return Observation() if is_folded else Observation(outline=self._outline)

    def perform(self, motion: StepMotion) -> Performed:
        self.asked.append(motion)
        has = len(self.asked) > self._misses
        return Performed({grip.arm: has or number > 0 for number, grip in enumerate(motion.grips)})

    def truth(self) -> None:
        return


def outline_at(x_m: float, y_m: float, turn_rad: float = 0.0) -> FloatArray:
    plan = towel_plan()
    lies = plan.task.start.placement
    moved = Pose2(lies.x_m + x_m, lies.y_m + y_m, lies.yaw_rad + turn_rad)
    return evenly_along(moved.to_outer(plan.garment.pattern.ring), 0.01)


def no_plan(task: Task) -> Plan:
    raise AssertionError(f"nobody should plan again from {task.start}")


def test_grips_follow_cloth_that_lies_two_centimetres_away() -> None:
    world = NotedWorld(outline_at(0.012, -0.016))
    done = Performer(towel_plan(), world, Gate(), no_plan).performed()
    (asked,), (planned,) = world.asked, step_motions(towel_plan())
    assert [decision.code for decision in done.decisions] == ["seen", "corrected"]
    for grip, former in zip(asked.grips, planned.grips, strict=True):
        for end in (0, -1):  # between them hands keep the cloth longer than planned
            gone = np.subtract(grip.points[end], former.points[end])
            assert gone == pytest.approx([0.012, -0.016, 0.0], abs=1e-3)


def test_a_fold_by_hands_that_hold_on_from_a_drag_is_not_carried_along_again() -> None:
    # Cloth 2 cm aside is taken there and dragged to where it should be: the fold after it is the planned one.
    plan = shipped_plan("skirt")
    lies = plan.task.start.placement
    moved = Pose2(lies.x_m + 0.012, lies.y_m - 0.016, lies.yaw_rad)
    world = NotedWorld(evenly_along(moved.to_outer(plan.garment.pattern.ring), 0.01))
    Performer(plan, world, Gate(), lambda _: plan).performed()
    asked, planned = world.asked, step_motions(plan)
    assert [motion.kind for motion in planned[:2]] == ["drag", "fold"] and not planned[0].grips[0].opens
    for grip, former in zip(asked[0].grips, planned[0].grips, strict=True):
        assert math.dist(grip.points[0], former.points[0]) == pytest.approx(0.02, abs=2e-3)
        assert grip.points[-1] == pytest.approx(former.points[-1], abs=1e-9)
    for grip, former in zip(asked[1].grips, planned[1].grips, strict=True):
        assert np.array(grip.points) == pytest.approx(np.array(former.points), abs=1e-9)


class SwingingWorld(NotedWorld):
    """Cloth that has turned about the hand that drags it."""

    def __init__(self, plan: Plan, turn_rad: float) -> None:
        super().__init__(evenly_along(plan.task.start.placement.to_outer(plan.garment.pattern.ring), 0.01))
        self._plan, self._turn_rad = plan, turn_rad
        self.carried = Isometry()

    def perform(self, motion: StepMotion) -> Performed:
        if motion.is_drag and not self.asked:
            after, (x, y, _) = self._plan.steps[0].after, motion.grips[0].points[-1]
            about = Isometry.rotation(0.0, x, y)
            self.carried = about.after(Isometry.rotation(self._turn_rad)).after(about.inverse)
            lies = after.placement.to_outer(evenly_along(self._plan.garment.pattern.ring, 0.01))
            self._outline = self.carried.apply(lies)
        return super().perform(motion)


def test_the_fold_after_a_drag_goes_over_the_line_as_the_cloth_lies_then() -> None:
    # A tie swings behind the one hand that drags it. The hand stays where it is, and lands where the fold brings that,
    # short by what its fingers reach ahead, twice, and their thickness: cloth turns over round their ends.
    plan = shipped_plan("tie")
    world = SwingingWorld(plan, 0.02)
    Performer(plan, world, Gate(), lambda _: plan).performed()
    drag, fold = world.asked[:2]
    assert drag.is_drag and fold.is_fold and not fold.grips[0].closes
    begin, end = (fold.grips[0].points[number][:2] for number in (0, -1))
    over = StepSeen(plan, plan.steps[1], fold, world.carried).fold
    assert over is not None
    assert begin == pytest.approx(drag.grips[0].points[-1][:2], abs=1e-9)
    landed = np.array(over.apply_point(begin))
    way = (landed - begin) / np.linalg.norm(landed - begin)
    fingers = robot_card_file(plan.task.robot).arms[0].gripper
    short_m = min(plan.task.limits.comfort_radius_m, 2.0 * reach_ahead(fold.grips[0]) + fingers.finger_thickness_m)
    assert short_m > 0.025
    assert end == pytest.approx(landed - short_m * way, abs=2e-3)
    assert math.dist(end, step_motions(plan)[1].grips[0].points[-1][:2]) > 0.01


def test_a_hand_that_misses_tries_again_within_the_comfort_radius() -> None:
    world = NotedWorld(outline_at(0.0, 0.0), misses=2)
    done = Performer(towel_plan(), world, Gate(), no_plan).performed()
    assert [decision.code for decision in done.decisions] == ["seen", "corrected", "regrasped", "regrasped"]
    first, *others = world.asked
    assert not done.reason
    for other in others:
        assert other.needs_all
    (planned,) = step_motions(towel_plan())
    apart = [
        [math.dist(a.points[0], b.points[0]) for a, b in zip(one.grips, planned.grips, strict=True)]
        for one in (first, *others)
    ]
    assert apart == [pytest.approx([miss_m, 0.0], abs=1e-3) for miss_m in (0.0, 0.01, 0.01)]


@pytest.mark.parametrize("name", [*(pytest.param(name, marks=pytest.mark.long) for name in ("tie", "scarf")), "skirt"])
def test_a_hand_that_misses_the_edge_of_cloth_that_it_pulls_behind_it_tries_again_inside_it(name: str) -> None:
    # Ahead of that hand there is no cloth.
    plan = shipped_plan(name)
    lies = plan.task.start.placement
    turned = replace(lies, yaw_rad=lies.yaw_rad + 0.01)
    world = NotedWorld(evenly_along(turned.to_outer(plan.garment.pattern.ring), 0.01), misses=1)
    Performer(plan, world, Gate(), lambda _: plan).performed()
    missed, again = world.asked[:2]
    assert missed.is_drag and again.is_drag
    begin, end = (np.array(missed.grips[0].points[number][:2]) for number in (0, -1))
    tried = np.array(again.grips[0].points[0][:2])
    cloth = Region.polygon(turned.to_outer(plan.garment.pattern.ring))
    assert not cloth.contains(tuple(begin + 0.01 * (end - begin) / np.linalg.norm(end - begin)))
    assert np.linalg.norm(tried - begin) == pytest.approx(0.01, abs=1e-6)
    assert cloth.contains(tuple(tried), margin_m=0.006)


def test_cloth_beyond_the_comfort_radius_is_planned_from_where_it_lies_and_given_up_in_the_end() -> None:
    asked: list[Task] = []

    def same(task: Task) -> Plan:
        asked.append(task)
        return towel_plan()

    world = NotedWorld(outline_at(0.05, 0.0))
    done = Performer(towel_plan(), world, Gate(), same).performed()
    assert len(asked) == FAILURES_MAX
    # Before each new plan the robot stands as that begins: it knows its own arms in the next picture by that.
    assert [motion.kind for motion in world.asked] == [WITHDRAW] * FAILURES_MAX
    assert all(motion.ends == home() for motion in world.asked)
    start = towel_plan().task.start.placement
    assert asked[0].start.placement.x_m == pytest.approx(start.x_m + 0.05, abs=2e-3)
    assert str(FAILURES_MAX) in done.reason
    assert done.steps == ()


def test_the_rest_is_planned_again_with_as_much_work_as_the_plan_had_time_however_slow_the_machine() -> None:
    asked: list[Task] = []

    def same(task: Task) -> Plan:
        asked.append(task)
        return towel_plan()

    Performer(towel_plan(), NotedWorld(outline_at(0.05, 0.0)), Gate(), same).performed()
    had = towel_plan().task.limits
    assert had.work_limit_s is None
    assert {task.limits.work_limit_s for task in asked} == {had.time_limit_s}
    assert {task.limits.time_limit_s for task in asked} == {TIME_LIMIT_S[1]}


def test_a_scarf_that_lies_closer_than_planned_is_still_taken_by_both_corners() -> None:
    # Its edge is 25.4 cm wide, and one hand in the middle would be quicker by half a second.
    plan = shipped_plan("scarf")
    last = plan.steps[2]
    lies = Pose2(-1.139, 0.326, last.before.placement.yaw_rad + 0.0067)
    rest = rest_task(plan.task, replace(last.before, placement=lies))
    assert [len(step.holdings) for step in make_plan(rest).steps] == [2, 2]


def test_a_fold_taken_at_another_point_lands_where_the_fold_brings_that_point() -> None:
    (motion,) = step_motions(towel_plan())
    (fold,) = towel_plan().sequence.folds
    lies = towel_plan().task.start.placement
    to_table = Isometry.rotation(lies.yaw_rad, lies.x_m, lies.y_m)
    over = to_table.after(Isometry.reflection(fold.line)).after(to_table.inverse)
    seen = StepSeen(towel_plan(), towel_plan().steps[0], motion)
    trials = list(regrasps(seen, frozenset({motion.grips[0].arm})))
    assert len(trials) == 8
    for offsets in trials:
        trial = beside_grips(motion, replace(seen, offsets=offsets))
        grip = trial.grips[0]
        assert grip.points[-1][:2] == pytest.approx(over.apply_point(grip.points[0][:2]), abs=1e-9)
        assert trial.grips[1] == motion.grips[1]


def test_a_hand_that_missed_where_the_cloth_was_seen_tries_again_round_there_within_the_radius_of_its_grip() -> None:
    (motion,) = step_motions(towel_plan())
    grip = motion.grips[0]
    seen = StepSeen(towel_plan(), towel_plan().steps[0], motion, offsets={grip.arm: (0.0, 0.02)})
    beside = [trial[grip.arm] for trial in regrasps(seen, frozenset({grip.arm}))]
    way = np.subtract(grip.points[-1], grip.points[0])[:2]
    assert beside[0] == pytest.approx(np.array([0.0, 0.02]) + 0.01 * way / np.linalg.norm(way), abs=1e-3)
    assert max(math.hypot(*gone) for gone in beside) <= 0.03 + 1e-9


def test_a_hand_that_took_the_cloth_beside_its_grip_holds_it_there_in_the_red_fold_after_it() -> None:
    plan = shipped_plan("letter-towel")
    world = NotedWorld(evenly_along(plan.task.start.placement.to_outer(plan.garment.pattern.ring), 0.01), misses=1)
    Performer(plan, world, Gate(), no_plan).performed()
    planned = step_motions(plan)
    _, blue, red = world.asked
    assert [motion.kind for motion in planned] == ["fold", "fold"] and not planned[1].grips[0].closes
    for before, after in zip(blue.grips, red.grips, strict=True):
        assert math.dist(before.points[-1][:2], after.points[0][:2]) < 1e-3
    offsets = [math.dist(a.points[-1], b.points[-1]) for a, b in zip(red.grips, planned[1].grips, strict=True)]
    # The miss was tried again 1 cm further in: that hand ends 1 cm less far. Both have laid the edge down short.
    assert sorted(offsets) == pytest.approx([SHORT_M, 0.01 + SHORT_M], abs=2e-3)


def test_a_correction_carries_a_step_along_and_its_shift_is_that_of_the_furthest_grip() -> None:
    (motion,) = step_motions(towel_plan())
    carried = carry(Pose2(0.1, 0.2, 0.3), Pose2(0.1, 0.21, 0.3))
    seen = StepSeen(towel_plan(), towel_plan().steps[0], motion, carried)
    assert seen.shift_m == pytest.approx(0.01)
    assert seen.spare_m == pytest.approx(seen.radius_m - 0.01)
    assert replace(seen, motion=carried_along(motion, seen)).shift_m == pytest.approx(0.01)
    assert carried_along(motion, replace(seen, carried=Isometry())) == motion


def test_a_robot_that_sees_from_where_it_stands_corrects_its_base_error_too() -> None:
    world = NotedWorld(outline_at(0.0, 0.0))
    noisy = NoisyWorld(world, Noise(base_m=0.005, base_rad=0.005), 3, towel_plan().task)
    Performer(towel_plan(), noisy, Gate(), no_plan).performed()
    (asked,), (planned,) = world.asked, step_motions(towel_plan())
    for grip, former in zip(asked.grips, planned.grips, strict=True):
        assert math.dist(grip.points[0], former.points[0]) < 2e-3


def test_a_robot_stands_where_its_base_and_its_tools_really_are() -> None:
    plan = towel_plan()
    world, (fold,) = NotedWorld(np.empty((0, 2))), step_motions(plan)
    noisy = NoisyWorld(world, Noise(base_m=0.01, arm_m=0.003), 3, plan.task)
    noisy.perform(fold)
    ends, believed = world.asked[0].ends, fold.ends
    assert ends is not None and believed is not None
    error = carry(believed.base, ends.base)
    assert 0.003 < math.hypot(error.x, error.y) < 0.04
    robot = load_robot(plan.task.robot)
    for number, (arm, grip, asked) in enumerate(zip(robot.card.arms, fold.grips, world.asked[0].grips, strict=True)):
        stands, thought = (
            robot.tool_pose(number, np.array([posture.joints[name] for name in arm.joint_names]), 0.2)[0][:2]
            for posture in (ends, believed)
        )
        beside = asked.points[-1][:2] - error.apply(np.array([grip.points[-1][:2]]))[0]
        assert stands - thought == pytest.approx(beside, abs=3e-4)
        assert np.linalg.norm(beside) > 1e-4


def test_hands_that_hold_on_go_on_from_where_a_drag_has_stopped_short() -> None:
    # Else the cloth in them would jump by as much within one time step.
    plan = shipped_plan("skirt")
    world = NotedWorld(np.empty((0, 2)))
    noisy = NoisyWorld(world, Noise(undershoot=0.2, arm_m=0.003, base_rad=0.01), 3, plan.task)
    planned = step_motions(plan)
    for motion in planned:
        noisy.perform(motion)
    drag, fold = world.asked[:2]
    assert planned[0].is_drag and planned[1].is_fold and not planned[0].grips[0].opens
    for number, grip in enumerate(drag.grips):
        way, planned_way = (math.dist(one.points[0], one.points[-1]) for one in (grip, planned[0].grips[number]))
        assert 0.8 * planned_way < way + 0.006 and way < 0.99 * planned_way
        assert fold.grips[number].points[0] == pytest.approx(grip.points[-1], abs=2e-3)
    closing = next(motion for motion in planned[1:] if motion.grips[0].closes)
    begun, former = world.asked[closing.step].grips[0].points[0], closing.grips[0].points[0]
    assert math.dist(begun, former) < 0.02  # hands free, the base was driven to where it should be


def test_what_is_seen_while_a_drag_has_stopped_short_is_seen_from_where_the_base_really_stands() -> None:
    plan = shipped_plan("tie")
    lies = np.array([[0.0, 0.0], [0.3, 0.1]])
    world = NotedWorld(lies, shows_folded=True)
    noisy = NoisyWorld(world, Noise(undershoot=0.2), 3, plan.task)
    drag, fold = step_motions(plan)[:2]
    noisy.perform(drag)
    short = np.subtract(world.asked[0].grips[0].points[-1], drag.grips[0].points[-1])[:2]
    assert np.linalg.norm(short) > 0.003
    assert noisy.observe().outline == pytest.approx(lies - short)
    noisy.perform(fold)  # hands free, the base is driven to where it should be
    assert noisy.observe().outline == pytest.approx(lies)
