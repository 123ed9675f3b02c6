"""Grips with one finger under the cloth and one over it: their roll, their fingers, and what the plan says of them."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pinocchio as pin
import pytest

from app.files.grasp_poses import grasp_poses
from planner import Plan, load_garment
from planner.geometry.pose import FloatArray, Pose2
from planner.motion.edge_hands import EdgeHands
from planner.motion.joint_trajectory import CLOSED_M, OPEN_M
from planner.planning.plan_check import require_replay
from planner.robots.card import EDGE_OPEN_M, HELD_M
from planner.task.world_state import GripKind
from tests.builders import fold, garment
from tests.planning.found import found_plan
from tests.replay import hulls
from tests.replay.hands import TOOLS, robot
from tests.replay.planned import planned, shipped_plan
from tests.required import required
from tests.sweep import sweep

NAMES = ("hand-towel", "t-shirt", "jeans")
SIDE = {"left": "l_", "right": "r_"}
UPRIGHT_M, SLIDING_M = 0.01, 0.0015
SHUT_M = {"edge": HELD_M + 1e-6, "top": CLOSED_M + 1e-6}

each_name = sweep("name", NAMES, ("hand-towel", "jeans"))


@cache
def grips(name: str) -> list[tuple[str, GripKind, float, float]]:
    """Return the arm, the kind, and when fingers have closed and begin to open (s), of each grip that is new."""
    plan = shipped_plan(name)
    assert plan.trajectory is not None
    found = []
    for step in plan.steps:
        for grip in step.grips:
            (track,) = (one for one in plan.trajectory.grippers if one.arm == grip.arm)
            times, openings = np.array(track.times_s), np.array(track.openings_m)
            kind: GripKind = required(grip.kind)
            is_shut = openings < SHUT_M[kind]
            closed = np.flatnonzero(is_shut & (times > step.start_s) & (times < step.end_s + 1e-6))
            if len(closed) and track.opening_at(step.start_s) > SHUT_M[kind]:
                opened = np.flatnonzero(~is_shut & (np.arange(len(times)) > closed[0]))
                found.append((grip.arm, kind, float(times[closed[0]]), float(times[opened[0] - 1])))
    return found


def closing_axis(plan: Plan, arm: str, t_s: float) -> tuple[FloatArray, FloatArray]:
    """Return the approach axis and the closing axis of a hand at a time."""
    model, data = robot()
    q = pin.neutral(model)
    for joint, value in required(plan.trajectory).joints_at(t_s).items():
        one = model.joints[model.getJointId(joint)]
        q[one.idx_q : one.idx_q + one.nq] = value if one.nq == 1 else (math.cos(value), math.sin(value))
    pin.framesForwardKinematics(model, data, q)
    rotation = data.oMf[model.getFrameId(TOOLS[arm])].rotation
    return rotation[:, 0], rotation[:, 1]


def lowest_m(plan: Plan, arm: str, t_s: float) -> float:
    """Return how high over the table the lowest vertex of a gripper's meshes is at a time (m)."""
    hulls.robot().update_cfg(required(plan.trajectory).joints_at(t_s))
    heights = [
        (hulls.robot().get_transform(one.name) @ np.c_[points, np.ones(len(points))].T)[2].min()
        for one in hulls.bodies()
        if one.name.startswith(f"{SIDE[arm]}gripper") and len(points := hulls.link_vertices(one.name))
    ]
    return float(min(heights)) - plan.scene.table.height_m


@each_name
def test_every_grip_of_a_plan_has_a_kind_and_some_hold_an_edge(name: str) -> None:
    kinds = [grip.kind for step in shipped_plan(name).steps for grip in step.grips]
    assert set(kinds) <= {"edge", "top"} and "edge" in kinds
    assert [grip["kind"] for one in planned(name).plan["primitives"] for grip in one["grips"]] == kinds


@each_name
def test_at_an_edge_one_finger_is_above_the_other_and_else_they_are_side_by_side(name: str) -> None:
    plan = shipped_plan(name)
    for arm, kind, held_s, _ in grips(name):
        approach, closing = closing_axis(plan, arm, held_s)
        across = abs(closing[1] * approach[0] - closing[0] * approach[1])
        if kind == "edge":
            assert abs(closing[2]) == pytest.approx(math.hypot(approach[0], approach[1]), abs=UPRIGHT_M)
            assert across < UPRIGHT_M
        else:
            assert abs(closing[2]) < UPRIGHT_M


@each_name
def test_the_lower_finger_slides_on_the_table_as_the_fingers_close_and_open(name: str) -> None:
    plan, looked = shipped_plan(name), 0
    dwell_s = plan.scene.grip_dwell_s
    for arm, kind, held_s, opens_s in grips(name):
        if kind == "edge":
            looked += 1
            for t_s in (held_s - 0.8 * dwell_s, opens_s + 0.8 * dwell_s):
                assert 0.0 <= lowest_m(plan, arm, t_s) < SLIDING_M
            for t_s in np.linspace(held_s - dwell_s, held_s + 0.3, 9):
                assert lowest_m(plan, arm, float(t_s)) >= 0.0
    assert looked > 0


@each_name
def test_hands_rest_while_fingers_close_and_open_and_open_as_far_as_there_is_room(name: str) -> None:
    plan = shipped_plan(name)
    assert plan.trajectory is not None
    for arm, kind, held_s, opens_s in grips(name):
        (track,) = (one for one in plan.trajectory.grippers if one.arm == arm)
        wide_m = EDGE_OPEN_M if kind == "edge" else OPEN_M
        times = np.array(track.times_s)
        moving_s = (0.8 if kind == "edge" else 1.0) * plan.scene.grip_dwell_s + 1e-9
        closing = times[(times <= held_s) & (times >= held_s - moving_s)]
        opening = times[(times >= opens_s) & (times <= opens_s + moving_s)]
        assert max(track.opening_at(t) for t in opening) == pytest.approx(wide_m)
        assert max(track.opening_at(t) for t in closing) <= wide_m + 1e-9
        for moving in (closing, opening):
            shut = [t for t in moving if track.opening_at(t) > SHUT_M[kind]]
            joints = np.array([plan.trajectory.arms.at(t) for t in (min(shut), max(shut))])
            span = [n for n, joint in enumerate(plan.trajectory.arms.names) if joint.startswith(SIDE[arm])]
            assert np.ptp(joints[:, span], axis=0).max() < 1e-9


@each_name
def test_a_plan_with_edge_grips_can_be_replayed_and_reads_back(name: str) -> None:
    plan = shipped_plan(name)
    require_replay(plan)
    assert Plan.from_dict(planned(name).plan) == plan


def test_a_plan_that_does_not_say_how_it_holds_is_read_as_it_was_written() -> None:
    plan = shipped_plan("hand-towel")
    steps = tuple(replace(step, grips=tuple(replace(grip, kind=None) for grip in step.grips)) for step in plan.steps)
    older = replace(plan, steps=steps)
    written = older.to_dict()
    assert "kind" not in written["primitives"][0]["grips"][0]
    assert Plan.from_dict(written) == older


def test_exported_poses_say_how_each_hand_holds() -> None:
    plan = shipped_plan("hand-towel")
    told = [grip["kind"] for step in grasp_poses(plan)["steps"] for grip in step["grips"]]
    assert told and set(told) <= {"edge", "top"} and "edge" in told


@each_name
def test_hands_at_edges_cost_no_time(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setattr(EdgeHands, "ways", lambda *_: iter(()))
    without = found_plan(load_garment(name), time_limit_s=60.0).plan
    assert {grip.kind for step in without.steps for grip in step.grips} == {"top"}
    assert required(shipped_plan(name).cost_s) <= required(without.cost_s) + 1e-6


def test_of_equally_quick_hands_at_edges_one_that_rolls_over_with_the_cloth_is_taken() -> None:
    corners = ((0.2, 0.0), (0.4, 0.0), (0.5, 0.17), (0.4, 0.34), (0.2, 0.34), (0.1, 0.17))
    tip = fold((0.2, 0.0), (0.2, 0.34), name="tip")
    plan = found_plan(garment(corners, tip, placement=Pose2(-0.5, -0.3, 0.0))).plan
    (step,) = (number for number, one in enumerate(plan.steps) if one.kind == "fold")
    hands = [hand for one in required(plan.trajectory).of_step(step) for hand in one.phase.hands if hand]
    assert {grip.kind for grip in plan.steps[step].grips} == {"edge"}
    assert max(abs(roll) for hand in hands for roll in hand.rolls_rad) == pytest.approx(math.pi)
