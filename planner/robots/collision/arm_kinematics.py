"""Pose an arm's parts by the kinematics of its robot: the closed form of the PR2's arms, or chains of joints.

The checks take either: Numba compiles them once for each of the two.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from numba.core import types
from numba.extending import overload

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel
from planner.robots.collision.part_poses import PLACE, Index
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.arm_poses import pose_either


class ArmChains(NamedTuple):
    """The arms of a robot, joint after joint, the joints of the first arm first; see `planner.robots.chain.Chain`.

    Attributes:
        roots: where each arm's root is in the base frame with the lift down (m), shape (a, 3).
        first_joints: the number of each arm's first joint, shape (a,).
        rotations: the rotation from each joint's frame to the one before it, at joint value 0, shape (n, 3, 3).
        offsets: the position of each joint's frame in the one before it (m), shape (n, 3).
        is_prismatic: which joints slide, shape (n,).
        first_parts: the number of each arm's first part, and of the one after the last arm's last, shape (a + 1,).
        carriers: for each part of an arm which of the arm's joints carries it, in rising order, shape (p,).
    """

    roots: FloatArray
    first_joints: Index
    rotations: FloatArray
    offsets: FloatArray
    is_prismatic: BoolArray
    first_parts: Index
    carriers: Index


@kernel
def pose_chain(chains: ArmChains, lift_m: float, arm: int, joints: FloatArray, poses: FloatArray) -> None:
    """Set rotation and position of an arm's parts in the base frame.

    Args:
        chains: the arms.
        lift_m: how far the lift is raised (m).
        arm: the arm.
        joints: its joints (rad, m).
        poses: the poses of its parts, which are set, shape (p, 5, 3).
    """
    part, first = chains.first_parts[arm], chains.first_parts[arm]
    last, above = chains.first_parts[arm + 1], chains.first_joints[arm]
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    x, y, z = chains.roots[arm, 0], chains.roots[arm, 1], chains.roots[arm, 2] + lift_m
    f, t = chains.rotations, chains.offsets
    for i in range(len(joints)):
        n = above + i
        x += r00 * t[n, 0] + r01 * t[n, 1] + r02 * t[n, 2]
        y += r10 * t[n, 0] + r11 * t[n, 1] + r12 * t[n, 2]
        z += r20 * t[n, 0] + r21 * t[n, 1] + r22 * t[n, 2]
        f00, f01, f02 = f[n, 0, 0], f[n, 0, 1], f[n, 0, 2]
        f10, f11, f12 = f[n, 1, 0], f[n, 1, 1], f[n, 1, 2]
        f20, f21, f22 = f[n, 2, 0], f[n, 2, 1], f[n, 2, 2]
        a0, a1 = r00 * f00 + r01 * f10 + r02 * f20, r00 * f01 + r01 * f11 + r02 * f21
        b0, b1 = r10 * f00 + r11 * f10 + r12 * f20, r10 * f01 + r11 * f11 + r12 * f21
        c0, c1 = r20 * f00 + r21 * f10 + r22 * f20, r20 * f01 + r21 * f11 + r22 * f21
        r02, r12, r22 = (
            r00 * f02 + r01 * f12 + r02 * f22,
            r10 * f02 + r11 * f12 + r12 * f22,
            r20 * f02 + r21 * f12 + r22 * f22,
        )
        if chains.is_prismatic[n]:
            r00, r01, r10, r11, r20, r21 = a0, a1, b0, b1, c0, c1
            x, y, z = x + joints[i] * r02, y + joints[i] * r12, z + joints[i] * r22
        else:
            c, s = math.cos(joints[i]), math.sin(joints[i])
            r00, r01 = c * a0 + s * a1, c * a1 - s * a0
            r10, r11 = c * b0 + s * b1, c * b1 - s * b0
            r20, r21 = c * c0 + s * c1, c * c1 - s * c0
        while part < last and chains.carriers[part] == i:
            at = part - first
            poses[at, 0, 0], poses[at, 0, 1], poses[at, 0, 2] = r00, r01, r02
            poses[at, 1, 0], poses[at, 1, 1], poses[at, 1, 2] = r10, r11, r12
            poses[at, 2, 0], poses[at, 2, 1], poses[at, 2, 2] = r20, r21, r22
            poses[at, PLACE, 0], poses[at, PLACE, 1], poses[at, PLACE, 2] = x, y, z
            part += 1


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
