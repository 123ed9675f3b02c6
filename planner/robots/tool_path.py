"""The path of an arm's tool, pose after pose, and joints near to known ones that follow it.

At every pose the arm keeps near to known joints and is solved for the tool's pose, so the tool is exactly on its path.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.path_arm import PathArm

IsFree = Callable[[NDArray[np.int64], FloatArray], BoolArray]
"""A collision check: from the poses' indices (m,) and their joints (m, joints), tell which are free (m,)."""

LEAP_RAD = 0.4
"""Movement of a joint between neighbouring poses from which it counts as a jump (rad; m where it slides)."""


@dataclass(frozen=True, slots=True)
class ToolPath:
    """The path of an arm's tool: poses a centimetre or a few degrees apart.

    Attributes:
        positions: base frame, shape (n, 3), m.
        rotations: the tool's axes as columns, base frame, shape (n, 3, 3).
        spans_s: the longest duration wanted for each step from pose to pose (s), shape (n - 1,); infinite where time
            does not matter.
        core: the first of the poses that matter, and the one after their last; the others only lead there and away.
    """

    positions: FloatArray
    rotations: FloatArray
    spans_s: FloatArray
    core: tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
class NoPath:
    """The result of a search that found no path for an arm.

    Attributes:
        blocked: poses of the path's core, counted from its first, at which the arm collides in every posture; empty
            where the path is only disconnected, shape (k,).
        is_core: whether the core alone has no path either, whatever leads there and away.
    """

    blocked: NDArray[np.int64]
    is_core: bool

    @property
    def is_hopeless(self) -> bool:
        """Whether no approach and retreat can give a path."""
        return self.is_core or len(self.blocked) > 0


def free_postures(
    arm: PathArm,
    position: FloatArray,
    rotation: FloatArray,
    torso_m: float,
    is_free: Callable[[FloatArray], BoolArray],
) -> FloatArray:
    """Return samples of an arm's joints that bring its tool to a pose and do not collide, shape (k, joints).

    Args:
        arm: the arm.
        position: the tool's position, base frame, shape (3,), m.
        rotation: its axes, base frame, shape (3, 3).
        torso_m: how far the torso is raised (m).
        is_free: the check of which joints, shape (m, joints), do not collide.
    """
    joints, costs = arm.samples(position[None], rotation[None], torso_m, -np.inf)
    able: FloatArray = joints[0, np.isfinite(costs[0])]
    return able[is_free(able)] if len(able) else able


def near_path(arm: PathArm, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray) -> FloatArray | None:
    """Return joints that keep a tool on a path, near to known joints: much faster than `ArmSearch`.

    Args:
        arm: the arm.
        path: the tool's path.
        torso_m: how far the torso is raised (m).
        is_free: the check of which joints are collision-free.
        known: joints to be near to, shape (n, joints), those that turn without end unwound.

    Returns:
        Joints, shape (n, joints), those that turn without end unwound; None where no joints so near are valid, which
        says nothing about others.
    """
    joints, bad = joints_along(arm, path, torso_m, known, is_free)
    return None if len(bad) else joints


def joints_along(
    arm: PathArm, path: ToolPath, torso_m: float, guides: FloatArray, is_free: IsFree
) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return the joints near guides at every pose of a path, and the poses where they are invalid."""
    joints, is_found = arm.along(path.positions, path.rotations, torso_m, guides)
    leaps = np.abs(np.diff(joints, axis=0)).max(axis=1, initial=0.0) > LEAP_RAD
    is_bad = ~is_found | np.append(leaps, False)
    if not is_bad.any():
        is_bad = ~is_free(np.arange(len(joints)), joints)
    return joints, np.flatnonzero(is_bad)
