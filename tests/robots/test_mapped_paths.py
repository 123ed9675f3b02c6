"""Joint paths of arms known by a reach map: on the path by another kinematics, within limits, without a jump."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.typing import NDArray

from planner.geometry.pose import Approach, BoolArray, FloatArray
from planner.robots.arm_path import ArmSearch
from planner.robots.arm_paths import arm_paths
from planner.robots.chain import PITCH, WHOLE, tool_poses
from planner.robots.described_robot import read_robot
from planner.robots.mapped_arm import ALL_ROUND, MappedArm
from planner.robots.newton import solve_from
from planner.robots.reach_maps import reach_map
from planner.robots.tool_path import IsFree, NoPath, ToolPath, free_postures, near_path
from tests.required import required
from tests.robots.required import joints_of

LEAP_RAD = 0.4
HALF_TURN = np.diag([1.0, -1.0, -1.0])
"""A gripper that is rolled by half a turn has its fingers where they were."""


class Bench:
    """The first arm of a robot at its table, with a map of a slice over it: whole maps take seconds."""

    def __init__(self, name: str, cache: Path) -> None:
        robot = read_robot(name)
        self.card, arm = robot.card, robot.arms[0]
        self.table_m = robot.card.scene.table.height_m
        shoulder_m = float(arm.root[2])
        heights_m = (self.table_m - shoulder_m, self.table_m + 0.08 - shoulder_m)
        self.chain, self.root = arm.chain, arm.root
        self.arm = MappedArm(arm, reach_map(arm.chain, ALL_ROUND, heights_m, directory=cache))
        self.speeds = np.full(len(arm.chain.low), 2.0)
        self._model = pin.buildModelFromXML(robot.urdf)
        self._data = self._model.createData()

    def search(self, path: ToolPath, is_free: IsFree | None = None) -> ArmSearch:
        return ArmSearch(self.arm, self.speeds, path, 0.0, self.table_m, is_free or everywhere)

    def found(self, path: ToolPath, is_free: IsFree | None = None) -> FloatArray | NoPath:
        return self.search(path, is_free).found()

    def pin_pose(self, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the tool's pose as pinocchio has it."""
        part, q = self.card.arms[0], pin.neutral(self._model)
        for name, value in zip(part.joints, joints, strict=True):
            q[self._model.joints[self._model.getJointId(name)].idx_q] = value
        pin.forwardKinematics(self._model, self._data, q)
        link = pin.updateFramePlacement(self._model, self._data, self._model.getFrameId(part.tool.link))
        approach, closing = np.array(part.tool.approach), np.array(part.tool.closing)
        axes = np.column_stack([approach, closing, np.cross(approach, closing)])
        return link.act(np.array(part.tool.offset_m)), link.rotation @ axes

    def require_followed(self, path: ToolPath, joints: FloatArray) -> None:
        """Require the tool at its pose everywhere, as far as the arm has joints for it, and an unbroken path."""
        assert (joints >= self.chain.low - 1e-9).all() and (joints <= self.chain.high + 1e-9).all()
        assert np.abs(np.diff(joints, axis=0)).max() < LEAP_RAD
        first = self.pin_pose(joints[0])[1]
        is_over = first[:, 1] @ path.rotations[0][:, 1] < 0.0
        for at, position, rotation in zip(joints, path.positions, path.rotations, strict=True):
            place, axes = self.pin_pose(at)
            np.testing.assert_allclose(place, position, atol=1e-4)
            if self.arm.chain.rows == PITCH:
                assert axes[2, 0] == pytest.approx(rotation[2, 0], abs=1e-4)
            else:
                np.testing.assert_allclose(axes, rotation @ HALF_TURN if is_over else rotation, atol=1e-4)


def everywhere(_: NDArray[np.int64], joints: FloatArray) -> BoolArray:
    return np.ones(len(joints), dtype=bool)


@pytest.fixture(scope="module")
def benches(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Bench]:
    cache = tmp_path_factory.mktemp("cache")
    return {name: Bench(name, cache) for name in ("so101-pair", "ur5e-pair")}


@pytest.fixture
def so101(benches: dict[str, Bench]) -> Bench:
    return benches["so101-pair"]


@pytest.fixture
def ur5e(benches: dict[str, Bench]) -> Bench:
    return benches["ur5e-pair"]


def line(start: FloatArray, end: FloatArray, pitch_deg: float, yaw_deg: float = 0.0) -> ToolPath:
    """Return a straight path in steps of a centimetre, in one orientation, without time pressure."""
    count = math.ceil(math.dist(start, end) / 0.01) + 1
    rotation = Approach(math.radians(yaw_deg), math.radians(pitch_deg)).rotation
    positions = np.linspace(start, end, count)
    return ToolPath(positions, np.broadcast_to(rotation, (count, 3, 3)), np.full(count - 1, np.inf), (0, count))


def before(bench: Bench, ahead_m: float, aside_m: float, over_m: float) -> FloatArray:
    """Return a point before an arm's shoulder, over the table."""
    return np.array([bench.root[0] + ahead_m, bench.root[1] + aside_m, bench.table_m + over_m])


def turning(place: FloatArray, pitch_deg: float, turns: float) -> ToolPath:
    """Return a path on which the hand only rolls about its approach axis, 0.1 rad a pose."""
    count = math.ceil(turns * math.tau / 0.1) + 1
    c, s = (f(np.linspace(0.0, turns * math.tau, count)) for f in (np.cos, np.sin))
    about_x = np.zeros((count, 3, 3))
    about_x[:, 0, 0], about_x[:, 1, 1], about_x[:, 2, 2], about_x[:, 1, 2], about_x[:, 2, 1] = 1.0, c, c, -s, s
    rotations = Approach(0.0, math.radians(pitch_deg)).rotation @ about_x
    return ToolPath(np.tile(place, (count, 1)), rotations, np.full(count - 1, np.inf), (0, count))


def random_lines(bench: Bench, count: int, length_m: float) -> list[ToolPath]:
    """Return lines over the table all of whose poses are within reach."""
    rng = np.random.default_rng(3)
    lines: list[ToolPath] = []
    while len(lines) < count:
        ahead, aside, over = rng.uniform((0.1, -0.6, 0.0), (1.0, 0.6, 0.06)) * (length_m / 0.3, length_m / 0.3, 1.0)
        start = before(bench, ahead, aside, over)
        bearing, rise = rng.uniform(-math.pi, math.pi), rng.uniform(0.0, 0.03)
        end = start + np.array([length_m * math.cos(bearing), length_m * math.sin(bearing), rise])
        path = line(start, end, rng.choice([30, 45, 60, 75, 90]), rng.choice([-30, 0, 30]))
        if bench.arm.can_reach(path.positions, path.rotations).all():
            lines.append(path)
    return lines


@pytest.mark.long
def test_an_arm_of_six_joints_is_on_its_path_at_every_pose(ur5e: Bench) -> None:
    for pitch_deg in (30, 60, 90):
        path = line(before(ur5e, 0.5, -0.15, 0.03), before(ur5e, 0.6, 0.15, 0.07), pitch_deg)
        ur5e.require_followed(path, joints_of(ur5e.found(path)))


def test_an_arm_of_five_joints_is_on_its_path_with_the_pitch_that_is_asked(so101: Bench) -> None:
    for pitch_deg in (45, 60, 75):
        path = line(before(so101, 0.2, -0.08, 0.02), before(so101, 0.25, 0.08, 0.04), pitch_deg)
        so101.require_followed(path, joints_of(so101.found(path)))


@pytest.mark.parametrize(("name", "length_m"), [("ur5e-pair", 0.3), ("so101-pair", 0.12)])
def test_nearly_every_line_within_reach_has_joints(benches: dict[str, Bench], name: str, length_m: float) -> None:
    bench, followed = benches[name], 0
    for path in random_lines(bench, 40, length_m):
        joints = bench.found(path)
        if not isinstance(joints, NoPath):
            bench.require_followed(path, joints)
            followed += 1
    assert followed >= 38, "of 40; whether the others have any is a question for a denser search"


def test_samples_of_a_pose_take_it_with_the_fingers_either_way_round(ur5e: Bench) -> None:
    pose = line(before(ur5e, 0.5, 0.0, 0.05), before(ur5e, 0.5, 0.01, 0.05), 60)
    position, rotation = pose.positions[0], pose.rotations[0]
    able = free_postures(ur5e.arm, position, rotation, 0.0, lambda joints: np.ones(len(joints), dtype=bool))
    sides = []
    for joints in able:
        place, axes = ur5e.pin_pose(joints)
        np.testing.assert_allclose(place, position, atol=1e-4)
        np.testing.assert_allclose(axes[:, 0], rotation[:, 0], atol=1e-4)
        sides.append(axes[:, 1] @ rotation[:, 1])
    np.testing.assert_allclose(np.abs(sides), 1.0, atol=1e-6)
    assert sum(side > 0.0 for side in sides) == sum(side < 0.0 for side in sides) >= 4
    low = free_postures(ur5e.arm, position, rotation, 0.0, lambda joints: joints[:, 2] < 0.0)
    assert 0 < len(low) < len(able)
    assert (low[:, 2] < 0.0).all()


def test_near_to_known_joints_there_are_joints_for_a_path_nearby(ur5e: Bench) -> None:
    path = line(before(ur5e, 0.5, -0.15, 0.03), before(ur5e, 0.6, 0.15, 0.07), 60)
    known = joints_of(ur5e.found(path))
    shifted = replace(path, positions=path.positions + np.array([0.004, 0.003, 0.002]))
    near = required(near_path(ur5e.arm, shifted, 0.0, everywhere, known))
    ur5e.require_followed(shifted, near)
    np.testing.assert_allclose(near, known, atol=0.05)
    beyond = replace(path, positions=path.positions + np.array([1.5, 0.0, 0.0]))
    assert near_path(ur5e.arm, beyond, 0.0, everywhere, known) is None


def test_an_arm_goes_round_what_the_calmest_path_would_run_into(ur5e: Bench) -> None:
    path = line(before(ur5e, 0.5, -0.15, 0.03), before(ur5e, 0.6, 0.15, 0.07), 60)
    side = np.sign(joints_of(ur5e.found(path))[:, 2])
    other = joints_of(ur5e.found(path, lambda poses, joints: np.sign(joints[:, 2]) != side[poses]))
    ur5e.require_followed(path, other)
    assert (np.sign(other[:, 2]) != side).all()


def test_a_hand_rolls_as_far_as_its_last_joint_has_turns_and_no_farther(ur5e: Bench) -> None:
    place = before(ur5e, 0.5, 0.0, 0.05)
    path = turning(place, 60, 1.6)
    ur5e.require_followed(path, joints_of(ur5e.found(path)))
    assert isinstance(ur5e.found(turning(place, 60, 2.4)), NoPath), "the last joint has two turns"


def test_a_chain_is_wound_up_within_the_limits_wherever_it_begins(ur5e: Bench) -> None:
    rng = np.random.default_rng(5)
    smooth = np.cumsum(rng.uniform(-0.2, 0.2, (50, 6)), axis=0)
    wrapped = smooth + rng.uniform(-3.0, 3.0, 6)
    wide = ur5e.arm.periods > 0.0
    assert wide.tolist() == [True, True, False, True, True, True], "the elbow has one turn, the others two"
    wrapped[:, wide] = (wrapped[:, wide] + math.pi) % math.tau - math.pi
    unwound = ur5e.arm.unwound(wrapped)
    np.testing.assert_allclose(np.diff(unwound[:, wide], axis=0), np.diff(smooth[:, wide], axis=0), atol=1e-9)
    np.testing.assert_array_equal(unwound[:, ~wide], wrapped[:, ~wide])
    assert (np.abs(unwound[:, wide]) <= math.tau).all()


class UnlikeSides:
    """Arms that touch unless the first leans forward where the other's elbow is bent backward, or the reverse."""

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        return joints[:, 1] * joints[:, 7] < 0.0

    def postures_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> BoolArray:
        return first[:, 1][:, None] * second[:, 2] < 0.0


def test_arms_of_unlike_joints_samples_and_strides_give_way_to_each_other(so101: Bench, ur5e: Bench) -> None:
    assert so101.arm.stride < ur5e.arm.stride
    small = line(before(so101, 0.2, -0.08, 0.02), before(so101, 0.25, 0.08, 0.04), 60)
    large = line(before(ur5e, 0.5, -0.08, 0.02), before(ur5e, 0.55, 0.08, 0.04), 60)
    alone = np.hstack([joints_of(so101.found(small)), joints_of(ur5e.found(large))])
    assert not UnlikeSides().arms_apart((0, 1), alone).all(), "else neither gives way"
    found = joints_of(arm_paths({0: so101.search(small), 1: ur5e.search(large)}, UnlikeSides()))
    assert UnlikeSides().arms_apart((0, 1), found).all()
    so101.require_followed(small, found[:, :5])
    ur5e.require_followed(large, found[:, 5:])


def test_a_pose_half_a_turn_off_is_not_taken_for_the_pose(ur5e: Bench) -> None:
    joints = joints_of(ur5e.found(line(before(ur5e, 0.5, 0.0, 0.05), before(ur5e, 0.5, 0.1, 0.05), 60)))
    points, rotations = tool_poses(ur5e.chain, joints)
    for over in (HALF_TURN, np.diag([-1.0, 1.0, -1.0]), np.diag([-1.0, -1.0, 1.0])):
        found, ends = solve_from(ur5e.chain, points, rotations @ over, WHOLE, joints)
        np.testing.assert_allclose(tool_poses(ur5e.chain, ends[found])[1], (rotations @ over)[found], atol=1e-4)
