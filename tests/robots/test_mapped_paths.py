"""Joint paths of arms known by a map of postures: on the path by another kinematics, within limits, without a jump."""

import math
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from planner.geometry.pose import Approach, BoolArray, FloatArray
from planner.robots.arm_path import ArmSearch
from planner.robots.described_robot import read_robot
from planner.robots.mapped_arm import ALL_ROUND, MappedArm
from planner.robots.posture_maps import posture_map
from planner.robots.tool_path import NoPath, ToolPath

LEAP_RAD = 0.4
HALF_TURN = np.diag([1.0, -1.0, -1.0])
"""A gripper that is rolled by half a turn has its fingers where they were."""


class Bench:
    """The first arm of a robot at its table, with a map of a slice over it: whole maps take seconds."""

    def __init__(self, name: str, cache) -> None:
        robot = read_robot(name)
        self.card, arm = robot.card, robot.arms[0]
        self.table_m = robot.card.scene.table.height_m
        shoulder_m = float(arm.root[2])
        heights_m = (self.table_m - 0.02 - shoulder_m, self.table_m + 0.16 - shoulder_m)
        self.chain, self.root = arm.chain, arm.root
        self.arm = MappedArm(arm, posture_map(arm.chain, ALL_ROUND, heights_m, directory=cache))
        self.speeds = np.full(len(arm.chain.low), 2.0)
        self._model = pin.buildModelFromXML(robot.urdf)
        self._data = self._model.createData()

    def search(self, path: ToolPath, is_free=None) -> ArmSearch:
        return ArmSearch(self.arm, self.speeds, path, 0.0, self.table_m, is_free or everywhere)

    def found(self, path: ToolPath, is_free=None) -> FloatArray | NoPath:
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
            if self.arm.asks_pitch_only:
                assert axes[2, 0] == pytest.approx(rotation[2, 0], abs=1e-4)
            else:
                np.testing.assert_allclose(axes, rotation @ HALF_TURN if is_over else rotation, atol=1e-4)


def everywhere(_: FloatArray, joints: FloatArray, is_certain: bool) -> BoolArray:
    return np.ones(len(joints), dtype=bool)


@pytest.fixture(scope="module")
def benches(tmp_path_factory):
    cache = tmp_path_factory.mktemp("cache")
    return {name: Bench(name, cache) for name in ("so101-pair", "ur5e-pair")}


@pytest.fixture
def so101(benches) -> Bench:
    return benches["so101-pair"]


@pytest.fixture
def ur5e(benches) -> Bench:
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


def test_an_arm_of_six_joints_is_on_its_path_at_every_pose(ur5e):
    for pitch_deg in (30, 60, 90):
        path = line(before(ur5e, 0.5, -0.15, 0.03), before(ur5e, 0.6, 0.15, 0.1), pitch_deg)
        ur5e.require_followed(path, ur5e.found(path))


def test_an_arm_of_five_joints_is_on_its_path_with_the_pitch_that_is_asked(so101):
    for pitch_deg in (45, 60, 75):
        path = line(before(so101, 0.2, -0.08, 0.02), before(so101, 0.25, 0.08, 0.04), pitch_deg)
        so101.require_followed(path, so101.found(path))


def test_a_hand_that_rolls_a_whole_turn_leaves_no_limit(ur5e):
    path = line(before(ur5e, 0.5, 0.0, 0.05), before(ur5e, 0.5, 0.4, 0.05), 60)
    turns = np.linspace(0.0, 2.0 * math.tau, 160)
    rolls = np.array([[[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]] for a in turns])
    far = replace(
        path,
        positions=np.repeat(path.positions[:1], 160, axis=0),
        rotations=path.rotations[0] @ rolls,
        spans_s=np.full(159, np.inf),
        core=(0, 160),
    )
    once = replace(
        far, positions=far.positions[:80], rotations=far.rotations[:80], spans_s=far.spans_s[:79], core=(0, 80)
    )
    ur5e.require_followed(once, ur5e.found(once))
    wound = ur5e.found(far)
    if not isinstance(wound, NoPath):
        ur5e.require_followed(far, wound)
