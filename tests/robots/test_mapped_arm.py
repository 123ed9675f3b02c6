"""Arms of any robot: what their reach maps answer, against the PR2's closed form and another kinematics."""

import os
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.robots import reach_maps
from planner.robots.chain import tool_poses
from planner.robots.described_robot import DescribedArm, read_robot
from planner.robots.mapped_arm import ALL_ROUND, MappedArm, heights, mapped_arm
from planner.robots.reach_map import ReachMap
from planner.robots.reach_maps import Progress, covered_heights, covering, grid_of, reach_map
from planner.user_cache import CACHES, Cache
from tests.robots.model import can_reach, pin_pose, the_pr2

Poses: TypeAlias = tuple[FloatArray, FloatArray]
"""Positions and rotations of a tool, shapes (n, 3) and (n, 3, 3)."""

TORSO_M = 0.29
LOW_M, HIGH_M = 0.80, 0.88
"""A slice over the table: the maps of whole arms take seconds."""


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("cache")


def mapped(cache: Path, progress: Progress | None = None) -> MappedArm:
    arm = read_robot("pr2").arms[0]
    shoulder_m = float(arm.root[2]) + TORSO_M
    heights_m = (LOW_M - shoulder_m, HIGH_M - shoulder_m)
    return MappedArm(arm, reach_map(arm.chain, ALL_ROUND, heights_m, progress, cache))


@pytest.fixture(scope="module")
def poses() -> Poses:
    rng = np.random.default_rng(11)
    points = rng.uniform((-0.6, -0.6, LOW_M), (1.0, 1.1, HIGH_M), (3000, 3))
    chosen = rng.integers(0, len(ALL_ROUND), len(points))
    return points, np.array([ALL_ROUND[number].rotation for number in chosen])


def test_the_map_of_a_pr2_answers_as_its_closed_form(cache: Path, poses: Poses) -> None:
    arm, reference = mapped(cache), the_pr2()
    found, true = arm.can_reach(*poses, TORSO_M), can_reach(reference, 0, *poses, TORSO_M)
    assert true.sum() > 300
    assert not (found & ~true).any()
    assert (found & true).sum() >= 0.998 * true.sum()


def test_every_yes_has_joints_within_limits_that_take_the_pose(cache: Path, poses: Poses) -> None:
    arm, chain = mapped(cache), read_robot("pr2").arms[0].chain
    found, joints = arm.joints(*poses, TORSO_M)
    names = read_robot("pr2").card.arms[0].joints
    assert (joints[found] >= chain.low - 1e-9).all()
    assert (joints[found] <= chain.high + 1e-9).all()
    for number in np.flatnonzero(found)[:60]:
        values = {"torso_lift_joint": TORSO_M, **dict(zip(names, joints[number].tolist(), strict=True))}
        position, rotation = pin_pose("l_gripper_tool_frame", values)
        np.testing.assert_allclose(position, poses[0][number], atol=1e-4)
        np.testing.assert_allclose(rotation[:, 0], poses[1][number][:, 0], atol=1e-4)


def test_a_map_is_built_once_and_then_read_and_one_that_was_not_used_lately_is_dropped(
    tmp_path: Path, poses: Poses, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(CACHES, "postures", Cache("maps", 1))
    old = tmp_path / "postures" / "old.npz"
    old.parent.mkdir()
    old.write_bytes(b"a map of an earlier version")
    os.utime(old, (0, 0))
    told: list[float] = []
    built = mapped(tmp_path, told.append)
    assert told
    assert told[-1] == 1.0
    (kept,) = old.parent.iterdir()
    assert kept != old
    told.clear()
    read = mapped(tmp_path, told.append)
    assert not told
    np.testing.assert_array_equal(built.can_reach(*poses, TORSO_M), read.can_reach(*poses, TORSO_M))


def test_a_short_arm_reaches_what_random_joints_reach() -> None:
    # Its reach at a steep pitch is a thin shell, narrower than a cell of the map.
    robot = read_robot("so101-pair")
    arm, chain = mapped_arm(robot, 0), robot.arms[0].chain
    joints = np.random.default_rng(3).uniform(chain.low, chain.high, (100_000, len(chain.low)))
    points, rotations = tool_poses(chain, joints)
    low_m, high_m = heights(robot, robot.arms[0])
    ahead = rotations[:, :, 0]
    is_asked = (points[:, 2] > low_m) & (points[:, 2] < high_m) & (ahead[:, 2] < -0.25)
    is_asked &= (ahead[:, :2] * points[:, :2]).sum(axis=1) > 0.0
    found = arm.can_reach(points[is_asked] + robot.arms[0].root, rotations[is_asked])
    assert len(found) > 20_000
    assert found.mean() >= 0.998


def test_what_is_asked_above_or_below_a_map_is_looked_for_in_layers_of_it(
    cache: Path, poses: Poses, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reach_maps, "cache_folder", lambda: cache)
    monkeypatch.setattr(reach_maps, "LAYER_CELLS", reach_maps.LAYER_CELLS // 3)
    arm, reference = mapped(cache), the_pr2()
    before = arm.can_reach(*poses, TORSO_M)
    low_m, high_m = covered_heights(arm.known.grid)
    for below_m in (0.1, -0.1 - (HIGH_M - LOW_M)):
        moved = poses[0] - [0.0, 0.0, below_m]
        found, true = arm.can_reach(moved, poses[1], TORSO_M), can_reach(reference, 0, moved, poses[1], TORSO_M)
        assert true.sum() > 100
        assert (found & ~true).sum() <= 0.005 * true.sum()
        assert (found & true).sum() >= 0.99 * true.sum()
    deeper_m, higher_m = covered_heights(arm.known.grid)
    assert deeper_m < low_m - 0.1
    assert higher_m > high_m + 0.1
    np.testing.assert_array_equal(arm.can_reach(*poses, TORSO_M), before)


def unknown(arm: DescribedArm, heights_m: tuple[float, float]) -> ReachMap:
    """Return a map of heights without postures."""
    grid = grid_of(arm.chain, ALL_ROUND, heights_m)
    starts = np.zeros(int(np.prod(grid.counts)) * len(ALL_ROUND) + 1, dtype=np.int32)
    return ReachMap(grid, starts, np.zeros((0, len(arm.chain.low)), dtype=np.int8))


def test_no_layer_is_built_below_the_floor_or_beyond_the_arms_length(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("planner.robots.reach_maps.kept_map", lambda *_: pytest.fail("a layer was built"))
    described = read_robot("pr2").arms[0]
    floor_m = -float(described.root[2]) - TORSO_M
    to_floor, everywhere = unknown(described, (floor_m, 0.2)), unknown(described, (-9.0, 9.0))
    MappedArm(described, to_floor).cover(np.array([[0.5, 0.0, floor_m - 0.5], [0.5, 0.0, 0.1]]), TORSO_M)
    assert covering(described.chain, everywhere, (-9.0, 9.0)) is everywhere


@pytest.mark.long
def test_a_map_that_cannot_be_read_is_built_again(tmp_path: Path, poses: Poses) -> None:
    built = mapped(tmp_path)
    for path in (tmp_path / "postures").iterdir():
        path.write_bytes(b"broken")
    np.testing.assert_array_equal(built.can_reach(*poses, TORSO_M), mapped(tmp_path).can_reach(*poses, TORSO_M))
