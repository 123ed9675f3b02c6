"""Hands may be turned by half a turn, as two fingers are all one, only where that leaves the tool in place."""

import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.motion.transfer_path_finder import keeps_tool
from planner.robots.load_robot import load_robot
from planner.robots.pr2.robot import Pr2


class ToolElsewhere:
    """A PR2 whose tool point is beside that of its card, and points otherwise."""

    def __init__(self, robot: Pr2, offset: tuple[float, float, float], turn_rad: float) -> None:
        """Keep where the point is in the tool's frame (m), and how far the tool is turned about its second axis."""
        cos, sin = np.cos(turn_rad), np.sin(turn_rad)
        self._robot, self._offset = robot, np.array(offset)
        self._rotation = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        place, axes = self._robot.tool_pose(arm, joints, torso_m)
        return place + axes @ self._offset, axes @ self._rotation


@pytest.mark.parametrize("arm", [0, 1])
@pytest.mark.parametrize(
    ("offset", "turn_rad", "keeps"),
    [
        ((0.0, 0.0, 0.0), 0.0, True),
        ((0.02, 0.0, 0.0), 0.0, True),
        ((0.0, 0.0025, 0.0), 0.0, False),
        ((0.0, 0.0, 0.0), 0.1, False),
    ],
)
def test_half_a_turn_keeps_a_tool_that_is_on_the_axis_of_the_last_joint_and_points_along_it(
    arm: int, offset: tuple[float, float, float], turn_rad: float, *, keeps: bool
) -> None:
    robot = load_robot("pr2")
    assert isinstance(robot, Pr2)
    machine = ToolElsewhere(robot, offset, turn_rad)
    assert keeps_tool(machine, arm, robot.home(arm), 0.29) == keeps  # type: ignore[arg-type]
