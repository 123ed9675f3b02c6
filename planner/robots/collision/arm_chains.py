"""Poses of the parts of any serial arms, compiled."""

import math
from typing import NamedTuple

from numba import njit

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.collision.part_poses import PLACE, Index


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


@njit(cache=True, nogil=True)
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
    for i in range(len(joints)):
        f, t = chains.rotations[above + i], chains.offsets[above + i]
        x += r00 * t[0] + r01 * t[1] + r02 * t[2]
        y += r10 * t[0] + r11 * t[1] + r12 * t[2]
        z += r20 * t[0] + r21 * t[1] + r22 * t[2]
        a0, a1 = r00 * f[0, 0] + r01 * f[1, 0] + r02 * f[2, 0], r00 * f[0, 1] + r01 * f[1, 1] + r02 * f[2, 1]
        a2 = r00 * f[0, 2] + r01 * f[1, 2] + r02 * f[2, 2]
        b0, b1 = r10 * f[0, 0] + r11 * f[1, 0] + r12 * f[2, 0], r10 * f[0, 1] + r11 * f[1, 1] + r12 * f[2, 1]
        b2 = r10 * f[0, 2] + r11 * f[1, 2] + r12 * f[2, 2]
        c0, c1 = r20 * f[0, 0] + r21 * f[1, 0] + r22 * f[2, 0], r20 * f[0, 1] + r21 * f[1, 1] + r22 * f[2, 1]
        c2 = r20 * f[0, 2] + r21 * f[1, 2] + r22 * f[2, 2]
        if chains.is_prismatic[above + i]:
            r00, r01, r02, r10, r11, r12, r20, r21, r22 = a0, a1, a2, b0, b1, b2, c0, c1, c2
            x, y, z = x + joints[i] * r02, y + joints[i] * r12, z + joints[i] * r22
        else:
            c, s = math.cos(joints[i]), math.sin(joints[i])
            r00, r01, r02 = c * a0 + s * a1, c * a1 - s * a0, a2
            r10, r11, r12 = c * b0 + s * b1, c * b1 - s * b0, b2
            r20, r21, r22 = c * c0 + s * c1, c * c1 - s * c0, c2
        while part < last and chains.carriers[part] == i:
            pose = poses[part - first]
            pose[0, 0], pose[0, 1], pose[0, 2] = r00, r01, r02
            pose[1, 0], pose[1, 1], pose[1, 2] = r10, r11, r12
            pose[2, 0], pose[2, 1], pose[2, 2] = r20, r21, r22
            pose[PLACE, 0], pose[PLACE, 1], pose[PLACE, 2] = x, y, z
            part += 1
