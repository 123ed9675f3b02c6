"""Do free arms keep clear of the cloth that lies on the table?

Cloth is soft, but a hand that passes low over it sweeps it along. So it counts as slabs of a height, and what of an arm
may come low, from the elbow outwards, is compared with them.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.robot.collision.bodies import Bodies, Pairs
from planner.robot.collision.part_poses import EACH
from planner.robot.collision.parts import ELBOW
from planner.robot.collision.robot_parts import RobotParts, compiled_parts
from planner.robot.collision.rounded_hull import prism


class Clearance:
    """What is too low over cloth that lies somewhere. May be shared between threads."""

    def __init__(
        self,
        robot: RobotParts,
        level: int,
        pieces: Sequence[FloatArray],
        over_m: float,
        height_m: float,
        torso_m: float,
    ) -> None:
        """Put slabs beside the robot's arms.

        Args:
            robot: its parts.
            level: which of `OPENINGS_M` the fingers are open to.
            pieces: convex pieces of cloth, table frame, counter-clockwise, each of shape (n, 2), m.
            over_m: how high over them arms stay (m).
            height_m: the table top's height over the floor (m).
            torso_m: how far the torso is raised (m).
        """
        slabs = [prism(piece, over_m) for piece in pieces]
        shapes = (*robot.convexes[level], *(slab.convex() for slab in slabs))
        parts = compiled_parts(robot, level, [slab.corners for slab in slabs])
        poses, places = np.zeros((len(shapes), 5, 3)), np.tile([0.0, 0.0, height_m], (len(slabs), 1))
        self._bodies = Bodies(robot.arm, torso_m, parts, shapes, poses, places)
        self._of_arm = tuple(_pairs(arm, range(len(robot.names), len(shapes))) for arm in range(2))

    def arm_clear(
        self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray, *, is_certain: bool = False
    ) -> BoolArray:
        """At which joints of one arm, shape (n, 7), it is clear of all cloth, shape (n,).

        Args:
            arm: which arm.
            bases: where the base stands: one pose of the table frame for all, or x (m), y (m), yaw (rad) of each.
            joints: the arm's joints (rad).
            is_certain: whether only those count that are certainly clear, which is quicker to tell.
        """
        return self._bodies.are_free(self._of_arm[arm], bases, joints[:, None], np.array([arm]), is_certain)


def _pairs(arm: int, slabs: range) -> Pairs:
    """An arm's outer parts and all slabs, the likeliest to be low first."""
    parts = range(EACH * arm + ELBOW, EACH * (arm + 1))
    numbers = np.array([*product(reversed(parts), slabs)], dtype=np.int64).reshape(-1, 2)
    return Pairs(numbers, np.zeros(len(numbers)))
