"""The share of the table in reach, counted by hand for arms whose reach is a ball."""

import math

import numpy as np
import pytest

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots import table_reach as module
from planner.robots.described_robot import read_robot
from planner.robots.table_reach import table_reach

BALL_M = 0.3


class Ball:
    """An arm that reaches all that is near to its root, from straight above alone."""

    def __init__(self, root: FloatArray) -> None:
        self.root = root

    def can_reach(self, positions: FloatArray, rotations: FloatArray, torso_m: float) -> BoolArray:
        is_down = rotations[:, 2, 0] < -math.cos(0.01)
        return np.asarray(is_down & (np.linalg.norm(positions - self.root, axis=1) <= BALL_M))


@pytest.fixture
def balls(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "all_arms", lambda robot, progress: [Ball(arm.root) for arm in robot.arms])


@pytest.mark.usefixtures("balls")
def test_shares_are_those_of_the_points_in_reach() -> None:
    robot = read_robot("so101-pair")
    scene = robot.card.scene
    station = scene.stations[0][1]
    reached = []
    for x in np.arange(-0.225, 0.25, 0.05):
        for y in np.arange(-0.325, 0.35, 0.05):
            point = np.array([x - station.x_m, y - station.y_m, scene.table.height_m + 0.02])
            reached.append([np.linalg.norm(point - arm.root) <= BALL_M for arm in robot.arms])
    by_hand = np.array(reached)
    found = table_reach(robot)
    assert found.arms == pytest.approx({"left": by_hand[:, 0].mean(), "right": by_hand[:, 1].mean()})
    assert found.any_arm == pytest.approx(by_hand.any(axis=1).mean())
    assert found.two_arms == pytest.approx(by_hand.all(axis=1).mean())
    assert 0.0 < found.two_arms < found.arms["left"] < found.any_arm < 1.0


@pytest.mark.usefixtures("balls")
def test_one_arm_never_reaches_with_two() -> None:
    assert table_reach(read_robot("ur5e-single")).two_arms == 0.0


@pytest.mark.slow
def test_two_small_arms_reach_the_middle_of_their_table_together() -> None:
    shares: list[float] = []
    found = table_reach(read_robot("so101-pair"), shares.append)
    assert 0.2 < found.two_arms < found.any_arm <= 1.0
    assert found.arms["left"] == pytest.approx(found.arms["right"], abs=0.05)
    assert all(0.0 <= share <= 1.0 for share in shares)
