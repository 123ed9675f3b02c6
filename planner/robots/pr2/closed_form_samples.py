"""Samples of the closed form for joint paths, and the joints that follow a tool between them.

At every pose of a tool path the arm has a family of solutions (see `planner.robots.pr2.kernel`): closed curves over the
arcs of pans. As in the kernel the arm is a left arm and poses are in its shoulder's frame (m, rad).
"""

import math

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel
from planner.robots.joint_chain import ELBOW_CLEAR_M, ELBOW_COST, LIMIT_COST, NEAR_LIMIT
from planner.robots.pr2.aim import aim_at
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.inverse_kinematics import nearby_joints, place_wrist, turn_hand
from planner.robots.pr2.joint_slack import slacks
from planner.robots.pr2.kernel import witness
from planner.robots.pr2.pan_arcs import MOST_ARCS, pan_arcs, pan_on

SAMPLES = 24
"""Samples at each pose for each branch of the elbow, over all arcs."""

_CROSSING_COST = 0.5
"""Cost per square metre of an elbow's squared distance beyond its shoulder, on the other arm's side."""

_MEET = 0.4
"""Value of cos(roll) below which the elbow's branches nearly meet, and pan hardly determines the other joints."""


@kernel
def solutions(
    shape: ArmShape, positions: FloatArray, rotations: FloatArray, floor: float
) -> tuple[FloatArray, FloatArray]:
    """Return samples of the joints that bring the tool to each pose.

    Args:
        shape: the arm.
        positions: tool points, shape (n, 3).
        rotations: the tool's axes as columns, shape (n, 3, 3).
        floor: the height over which elbows should preferably stay.

    Returns:
        The joints, shape (n, m, 7), and the samples' costs, shape (n, m): infinite where there is no solution.
    """
    count = len(positions)
    size = 2 * SAMPLES + 1
    joints, costs = np.zeros((count, size, 7)), np.full((count, size), np.inf)
    arcs, near = np.empty((MOST_ARCS, 2)), np.zeros(7)
    for i in range(count):
        x, y, z = positions[i]
        aim = aim_at(shape, x, y, z, rotations[i, 0, 0], rotations[i, 1, 0], rotations[i, 2, 0])
        found, theta = witness(shape, aim, arcs)
        arc_count = pan_arcs(shape, aim, arcs)
        per = SAMPLES // max(arc_count, 1)
        for number in range(size):
            if number == 0:
                if found < 0:
                    break
                arc, at = found, theta
            else:
                arc, sample = (number - 1) // (2 * per), (number - 1) % (2 * per)
                if arc >= arc_count:
                    break
                at = (sample + 0.5) * math.pi / per
                at -= math.tau if at > math.pi else 0.0
            pan, branch = pan_on(arcs[arc], at), 1.0 if at >= 0.0 else -1.0
            slack = slacks(shape, aim, pan)[0 if at >= 0.0 else 1]
            if slack < 0.0:
                continue
            place_wrist(shape, aim, pan, branch, joints[i, number])
            turn_hand(shape, aim, rotations[i], near, joints[i, number])
            if np.isnan(joints[i, number].sum()):
                continue
            costs[i, number] = _sample_cost(shape, joints[i, number], slack, floor)
    return joints, costs


@kernel
def _sample_cost(shape: ArmShape, joints: FloatArray, slack: float, floor: float) -> float:
    pan_slack = min(joints[0] - shape.pan.low, shape.pan.high - joints[0])
    tight = max(1.0 - min(slack, pan_slack) / NEAR_LIMIT, 0.0)
    low = max(floor + ELBOW_CLEAR_M + shape.upper * math.sin(joints[1]), 0.0)
    crossed = max(-math.sin(joints[0]) * (shape.offset + shape.upper * math.cos(joints[1])), 0.0)
    cost: float = LIMIT_COST * tight * tight + ELBOW_COST * low * low + _CROSSING_COST * crossed * crossed
    return cost


@kernel
def filled(
    shape: ArmShape, positions: FloatArray, rotations: FloatArray, guides: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Return the joints at every pose of a path: those with the pan and branch of its guide, or else the nearest to it.

    Args:
        shape: the arm.
        positions: tool points, shape (n, 3).
        rotations: the tool's axes, shape (n, 3, 3).
        guides: joints to be near to, shape (n, 7).

    Returns:
        The joints, shape (n, 7), continuous ones unwound along the path, and whether there are any, shape (n,).
    """
    count = len(positions)
    joints, is_found = np.empty((count, 7)), np.ones(count, dtype=np.bool_)
    near = guides[0].copy()
    for i in range(count):
        x, y, z = positions[i]
        aim = aim_at(shape, x, y, z, rotations[i, 0, 0], rotations[i, 1, 0], rotations[i, 2, 0])
        cos_roll = math.cos(guides[i, 2])
        is_inside = cos_roll >= 0.0
        near[4], near[6] = (guides[i, 4], guides[i, 6]) if i == 0 else (joints[i - 1, 4], joints[i - 1, 6])
        joints[i, 0] = math.nan
        pan = guides[i, 0]
        is_good = abs(cos_roll) >= _MEET and shape.pan.low <= pan <= shape.pan.high
        if is_good and slacks(shape, aim, pan)[0 if is_inside else 1] >= 0.0:
            place_wrist(shape, aim, pan, 1.0 if is_inside else -1.0, joints[i])
            turn_hand(shape, aim, rotations[i], near, joints[i])
        if np.isnan(joints[i].sum()):
            near[:4], near[5] = guides[i, :4], guides[i, 5]
            is_found[i], joints[i] = nearby_joints(shape, positions[i], rotations[i], near)
    return joints, is_found
