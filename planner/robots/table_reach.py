"""The share of its table that a robot reaches: a first check of whether a card fits the bench it describes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.table import Table
from planner.geometry.tolerance import ANGLE_RAD
from planner.robots.described_robot import DescribedRobot
from planner.robots.mapped_arm import ALL_ROUND, MappedArm, all_arms
from planner.robots.reach_maps import Progress

STEP_M = 0.05
"""The distance between the points of the table that are queried (m)."""

ABOVE_TABLE_M = 0.02
"""The height of the tool over the table at which they are queried (m): fingertips that are about to take cloth."""


@dataclass(frozen=True, slots=True)
class TableReach:
    """The shares of the table's points that arms reach, from any of the card's stations.

    Attributes:
        arms: by name, the share that each arm reaches in some direction of approach.
        any_arm: the share that at least one arm reaches.
        two_arms: the share that two arms reach, or more, from one station.
    """

    arms: dict[str, float]
    any_arm: float
    two_arms: float


def table_reach(robot: DescribedRobot, progress: Progress | None = None) -> TableReach:
    """Return how much of the table of its card's scene a robot reaches.

    An approach counts that is no flatter than the gripper can take cloth with its fingers side by side.

    Args:
        robot: the robot.
        progress: called with how far the maps are that must be built (0 to 1).
    """
    scene = robot.card.scene
    points = _grid(scene.table)
    reached = np.zeros((len(scene.stations), len(robot.arms), len(points)), dtype=np.bool_)
    mapped = all_arms(robot, progress)
    for number, described in enumerate(robot.arms):
        rotations = _rotations(described.card.gripper.pinch.side_by_side_rad)
        for at, (_, base) in enumerate(scene.stations):
            reached[at, number] = _reached(mapped[number], base.to_inner(points), rotations, scene.torso_m)
    by_arm = {arm.card.name: _share(reached[:, number].any(axis=0)) for number, arm in enumerate(robot.arms)}
    return TableReach(by_arm, _share(reached.any(axis=(0, 1))), _share((reached.sum(axis=1) >= 2).any(axis=0)))


def _grid(table: Table) -> FloatArray:
    """Return the points queried, table frame but with heights above the floor (m), shape (n, 3)."""
    x, y = (np.arange(-0.5 * size + 0.5 * STEP_M, 0.5 * size, STEP_M) for size in (table.depth_m, table.width_m))
    across = np.array(np.meshgrid(x, y)).reshape(2, -1).T
    return np.column_stack([across, np.full(len(across), table.height_m + ABOVE_TABLE_M)])


def _rotations(least_pitch_rad: float) -> FloatArray:
    steep = [approach.rotation for approach in ALL_ROUND if approach.pitch_rad >= least_pitch_rad - ANGLE_RAD]
    return np.array(steep)


def _reached(arm: MappedArm, points: FloatArray, rotations: FloatArray, torso_m: float) -> BoolArray:
    """Return which points, base frame, an arm reaches in at least one of some rotations; shape (n,)."""
    each = np.repeat(points, len(rotations), axis=0)
    found = arm.can_reach(each, np.tile(rotations, (len(points), 1, 1)), torso_m)
    return np.asarray(found.reshape(len(points), -1).any(axis=1))


def _share(points: ArrayLike) -> float:
    return float(np.asarray(points).mean())
