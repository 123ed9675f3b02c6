"""Where an arm's tool must be, pose after pose, and the joints near to known ones that bring it there.

At every pose the arm keeps to the known pan and branch of the elbow, and all else follows in closed form, so the tool
is exactly where it must be.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robot.joint_chain import filled, solutions
from planner.robot.sided_arm import SidedArm

IsFree = Callable[[NDArray[np.int64], FloatArray, bool], BoolArray]
"""Asked with the numbers of poses, shape (m,), and joints there, shape (m, 7): which of them do not collide; and with
whether only those count that certainly do not, which is quicker to answer."""

_LEAP_RAD = 0.4
"""Joints that go further than this between neighbouring poses have jumped (rad)."""


@dataclass(frozen=True, slots=True)
class ToolPath:
    """Where an arm's tool must be, pose after pose, a centimetre or a few degrees apart.

    Attributes:
        positions: base frame, shape (n, 3), m.
        rotations: the tool's axes as columns, base frame, shape (n, 3, 3).
        spans_s: how long each step from pose to pose should take at most (s), shape (n - 1,); infinite where time does
            not press.
        core: the first of the poses that matter, and the one after their last; those before and after only lead there
            and away.
    """

    positions: FloatArray
    rotations: FloatArray
    spans_s: FloatArray
    core: tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
class NoPath:
    """There is no path for an arm.

    Attributes:
        blocked: poses of the path's core, counted from its first, at which the arm collides whatever it does; none
            where it is only cut off, shape (k,).
        is_core: whether the core alone has no path either, whatever leads there and away.
    """

    blocked: NDArray[np.int64]
    is_core: bool

    @property
    def is_hopeless(self) -> bool:
        """Whether there is none whatever leads there and away."""
        return self.is_core or len(self.blocked) > 0


def free_postures(
    arm: SidedArm,
    position: FloatArray,
    rotation: FloatArray,
    torso_m: float,
    is_free: Callable[[FloatArray], BoolArray],
) -> FloatArray:
    """Samples of an arm's joints that bring its tool to a pose and do not collide (rad), shape (k, 7).

    Args:
        arm: the arm.
        position: the tool's place, base frame, shape (3,), m.
        rotation: its axes, base frame, shape (3, 3).
        torso_m: how far the torso is raised (m).
        is_free: asked with joints, shape (m, 7): which of them do not collide.
    """
    place = arm.mirrored_places(position)[None] - arm.shoulder(torso_m)
    joints, costs = solutions(arm.shape, place, arm.mirrored_rotations(rotation)[None], -np.inf)
    able = arm.mirrored_joints(joints[0, np.isfinite(costs[0])])
    return able[is_free(able)] if len(able) else able


def near_path(arm: SidedArm, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray) -> FloatArray | None:
    """Joints that keep a tool on a path, near to others that are known: much quicker than `ArmSearch`.

    Args:
        arm: the arm.
        path: where its tool must be.
        torso_m: how far the torso is raised (m).
        is_free: which joints do not collide.
        known: joints to be near to (rad), shape (n, 7), forearm and wrist roll unwound.

    Returns:
        Joints (rad), shape (n, 7), forearm and wrist roll unwound; None where none so near will do, which says nothing
        about others.
    """
    positions = arm.mirrored_places(path.positions) - arm.shoulder(torso_m)
    joints, bad = joints_along(
        arm, positions, arm.mirrored_rotations(path.rotations), arm.mirrored_joints(known), is_free
    )
    return None if len(bad) else joints


def joints_along(
    arm: SidedArm, positions: FloatArray, rotations: FloatArray, guides: FloatArray, is_free: IsFree
) -> tuple[FloatArray, NDArray[np.int64]]:
    """The joints near guides at every pose, poses and guides as the left arm sees them, and where they will not do."""
    joints, is_found = filled(arm.shape, positions, rotations, guides)
    leaps = np.abs(np.diff(joints, axis=0)).max(axis=1, initial=0.0) > _LEAP_RAD
    is_bad = ~is_found | np.append(leaps, False)
    named = arm.mirrored_joints(joints)
    if not is_bad.any():
        is_bad = ~is_free(np.arange(len(positions)), named, False)
    return named, np.flatnonzero(is_bad)
