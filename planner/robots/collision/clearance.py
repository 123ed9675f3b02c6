"""Check that free arms keep clear of the cloth on the table.

Cloth is soft, but a hand that passes low over it sweeps it along. The cloth is therefore modelled as slabs of a given
height, and compared with the parts of an arm that may come low.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.robots.collision.bodies import Bodies, Pairs
from planner.robots.collision.robot_parts import RobotParts, compiled_parts


class Clearance:
    """A check for arm parts that are too low over cloth on the table. Threads may share it."""

    def __init__(
        self,
        robot: RobotParts,
        level: int,
        pieces: Sequence[FloatArray],
        over_m: float,
        height_m: float,
        torso_m: float,
    ) -> None:
        """Put slabs over the cloth beside the robot's arms.

        Args:
            robot: the robot's parts.
            level: the index in the robot's openings of the fingers' opening.
            pieces: convex pieces of cloth, table frame, counter-clockwise, each of shape (n, 2), m.
            over_m: the height over the cloth that arms must keep (m).
            height_m: the table top's height over the floor (m).
            torso_m: how far the lift is raised (m).
        """
        slabs = [np.vstack([np.insert(piece, 2, z, axis=1) for z in (0.0, over_m)]) for piece in pieces]
        parts = compiled_parts(robot, level, slabs)
        slab_numbers = range(len(robot.names), len(robot.names) + len(slabs))
        poses, places = np.zeros((slab_numbers.stop, 5, 3)), np.tile([0.0, 0.0, height_m], (len(slabs), 1))
        self._bodies = Bodies(robot.kinematics, torso_m, parts, (), robot.is_mirrored, poses, places)
        low = [range(first, robot.of_arm(arm).stop) for arm, first in enumerate(robot.low_parts)]
        self._of_arm = tuple(_pairs(parts_of_arm, slab_numbers) for parts_of_arm in low)

    def arm_clear(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """Return at which joints of one arm, shape (n, joints), it is clear of all cloth, shape (n,).

        Args:
            arm: the arm's index.
            bases: the base pose in the table frame: one for all postures, or x (m), y (m), yaw (rad) of each.
            joints: the arm's joints (rad, m).
        """
        return self._bodies.are_free(self._of_arm[arm], bases, joints, np.array([arm]))


def _pairs(parts: range, slabs: range) -> Pairs:
    """Return the pairs of some parts of an arm with all slabs, the likeliest to be low first."""
    numbers = np.array([*product(reversed(parts), slabs)], dtype=np.int64).reshape(-1, 2)
    return Pairs(numbers, np.zeros(len(numbers)))
