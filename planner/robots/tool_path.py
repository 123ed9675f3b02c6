"""The path of an arm's tool, pose after pose, what searches ask of the arm, and joints near to known ones.

At every pose the arm keeps near to known joints and is solved for the tool's pose, so the tool is exactly on its path.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray


class PathArm(Protocol):
    """An arm whose tool is to follow a path.

    Joints are in rad (m where they slide). Poses are of the tool, in the base frame (m), in arrays of positions, shape
    (n, 3), and rotations, shape (n, 3, 3). An arm that cannot take whole poses takes what it can of them.
    """

    @property
    def periods(self) -> FloatArray:
        """A whole turn for each joint that a chain of samples may wind up, 0 for the others (rad), shape (joints,)."""
        ...

    @property
    def stride(self) -> int:
        """Poses of a path, a centimetre apart, from one link of a chain to the next: fewer for a small arm."""
        ...

    def samples(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, floor_m: float
    ) -> tuple[FloatArray, FloatArray]:
        """Return samples of the joints that bring the tool to each pose.

        Args:
            positions: the poses' positions.
            rotations: the poses' rotations.
            torso_m: how far the lift is raised (m).
            floor_m: the height over which elbows should preferably stay, base frame (m).

        Returns:
            The joints, shape (n, m, joints), and the samples' costs, shape (n, m): infinite where there is no sample.
        """
        ...

    def along(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, guides: FloatArray
    ) -> tuple[FloatArray, BoolArray]:
        """Return joints near to guides that bring the tool to each pose, shape (n, joints), and if they exist.

        Joints that turn without end come unwound.
        """
        ...

    def unwound(self, chain: FloatArray) -> FloatArray:
        """Return a chain of samples, shape (n, joints), with the joints that have periods wound up; a new array."""
        ...

    def tool_places(self, joints: FloatArray, torso_m: float) -> FloatArray:
        """Return the tool's positions for rows of joints, shape (n, joints) -> (n, 3), m."""
        ...


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
