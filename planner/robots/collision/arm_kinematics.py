"""Pose an arm's parts by the kinematics of its robot: the closed form of the PR2's arms, or chains of joints.

The checks take either: Numba compiles them once for each of the two.
"""

from collections.abc import Callable
from typing import TypeAlias

from numba.core import types
from numba.extending import overload

from planner.geometry.pose import FloatArray
from planner.robots.collision.arm_chains import ArmChains, pose_chain
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.arm_poses import pose_either

ArmKinematics: TypeAlias = ArmShape | ArmChains

_POSING: dict[type, Callable[..., None]] = {ArmShape: pose_either, ArmChains: pose_chain}


def pose_parts(kinematics: ArmKinematics, lift_m: float, arm: int, joints: FloatArray, poses: FloatArray) -> None:
    """Set rotation and position of an arm's parts in the base frame; for kernels.

    Args:
        kinematics: the arms.
        lift_m: how far the lift is raised (m).
        arm: the arm.
        joints: its joints (rad, m).
        poses: the poses of its parts, which are set, shape (p, 5, 3).
    """
    raise NotImplementedError


@overload(pose_parts, strict=False)  # strict compares annotations too
def _posing(
    kinematics: types.NamedTuple | types.NamedUniTuple, lift_m: object, arm: object, joints: object, poses: object
) -> Callable[..., None] | None:
    """Return what `pose_parts` is compiled to for a kind of kinematics."""
    pose = _POSING[kinematics.instance_class]
    return lambda kinematics, lift_m, arm, joints, poses: pose(kinematics, lift_m, arm, joints, poses)
