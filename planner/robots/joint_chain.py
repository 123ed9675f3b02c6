"""The calmest joint path of an arm whose tool follows a path.

At every pose of a tool path the arm has a family of solutions (see `planner.robots.kernel`): closed curves over the
arcs of pans. Taking the solution nearest to the one before, pose after pose, is short-sighted: the arm runs into a
joint's limit, or through the table, and must jump. So the curves are sampled at every pose, and dynamic programming
finds the cheapest chain through the samples. A link costs the squared time that the slowest joints need for it; a
sample costs more the nearer a joint is to its limit and the lower the elbow hangs. No link is longer than `JUMP_RAD`.

As in the kernel the arm is a left arm and poses are in its shoulder's frame (m, rad).
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.aim import aim_at
from planner.robots.arm import ArmShape
from planner.robots.inverse_kinematics import nearby_joints, place_wrist, turn_hand
from planner.robots.joint_slack import slacks
from planner.robots.kernel import witness
from planner.robots.pan_arcs import MOST_ARCS, pan_arcs, pan_on

SAMPLES = 24
"""Samples at each pose for each branch of the elbow, over all arcs."""

JUMP_RAD = 0.8
"""Largest movement of a joint between neighbouring poses of a chain (rad)."""

_LIMIT_COST, _NEAR_LIMIT = 0.05, 0.15
"""Cost of a sample with a joint at its limit, and the slack from which it costs nothing."""

_ELBOW_COST, _ELBOW_CLEAR_M = 2.0, 0.12
"""Cost of an elbow at the floor's height, and the height above it from which it costs nothing (m)."""

_CROSSING_COST = 0.5
"""Cost per square metre of an elbow's squared distance beyond its shoulder, on the other arm's side."""

_MEET = 0.4
"""Value of cos(roll) below which the elbow's branches nearly meet, and pan hardly determines the other joints."""

_LATE_COST = 100.0
"""Cost of each second that a link exceeds its span."""

_FOREARM, _HAND = 4, 6
"""Indices of the joints that turn without end: forearm and wrist roll."""


@njit(cache=True, nogil=True)
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
    arcs, frame, near = np.empty((MOST_ARCS, 2)), np.empty((3, 3)), np.zeros(7)
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
            turn_hand(shape, aim, rotations[i], near, joints[i, number], frame)
            if np.isnan(joints[i, number].sum()):
                continue
            costs[i, number] = _sample_cost(shape, joints[i, number], slack, floor)
    return joints, costs


@njit(cache=True, nogil=True)
def _sample_cost(shape: ArmShape, joints: FloatArray, slack: float, floor: float) -> float:
    pan_slack = min(joints[0] - shape.pan.low, shape.pan.high - joints[0])
    tight = max(1.0 - min(slack, pan_slack) / _NEAR_LIMIT, 0.0)
    low = max(floor + _ELBOW_CLEAR_M + shape.upper * math.sin(joints[1]), 0.0)
    crossed = max(-math.sin(joints[0]) * (shape.offset + shape.upper * math.cos(joints[1])), 0.0)
    cost: float = _LIMIT_COST * tight * tight + _ELBOW_COST * low * low + _CROSSING_COST * crossed * crossed
    return cost


@njit(cache=True, nogil=True, error_model="numpy")
def link_costs(
    before: FloatArray, count: int, after: FloatArray, speeds: FloatArray, span: float, costs: FloatArray
) -> None:
    """Set the summed squared times (s2) that the joints need from each of some samples to another; infinite for a jump.

    Where the slowest joint exceeds the span, the excess costs much more. The loops over samples have no branches, so
    that they are compiled to vector instructions.

    Args:
        before: the samples, one in each column (rad), shape (7, m).
        count: how many of the columns are wanted.
        after: the other sample (rad), shape (7,).
        speeds: the joints' top speeds (rad/s), shape (7,).
        span: the longest duration wanted (s).
        costs: overwritten with the costs, shape (2, m); its second row is scratch space.
    """
    cost, slowest = costs[0], costs[1]
    cost[:count] = 0.0
    slowest[:count] = 0.0
    for k in range(7):
        slowness, there, whole = 1.0 / speeds[k], after[k], math.tau if k in (_FOREARM, _HAND) else 0.0
        for a in range(count):
            turn = there - before[k, a]
            turn = abs(turn - whole * np.floor(turn * (1.0 / math.tau) + 0.5))
            needed = turn * slowness
            slowest[a] = max(slowest[a], needed)
            cost[a] += needed * needed if turn <= JUMP_RAD else math.inf
    for a in range(count):
        cost[a] += _LATE_COST * max(slowest[a] - span, 0.0)


@njit(cache=True, nogil=True, error_model="numpy")
def cheapest_chain(joints: FloatArray, costs: FloatArray, speeds: FloatArray, spans: FloatArray) -> NDArray[np.int64]:
    """Return the cheapest way through samples, one from each pose.

    Of equally cheap ways to a sample, the one that was cheaper so far is taken.

    Args:
        joints: the samples, shape (n, m, 7).
        costs: the samples' costs, shape (n, m); infinite where a sample must not be taken.
        speeds: the joints' top speeds (rad/s), shape (7,).
        spans: the longest duration wanted for each link (s), shape (n - 1,); infinite where time does not matter.

    Returns:
        The sample at each pose, shape (n,); empty if there is no way.
    """
    count, size = costs.shape
    best, parents = costs[0].copy(), np.full((count, size), -1, dtype=np.int64)
    able, columns, links = np.empty(size, dtype=np.int64), np.empty((7, size)), np.empty((2, size))
    for i in range(1, count):
        so_far, found = best.copy(), 0
        for a in range(size):
            if so_far[a] < np.inf:
                able[found], columns[:, found] = a, joints[i - 1, a]
                found += 1
        best[:] = np.inf
        for b in range(size):
            if costs[i, b] < np.inf:
                link_costs(columns, found, joints[i, b], speeds, spans[i - 1], links)
                for number in range(found):
                    a = able[number]
                    total = so_far[a] + costs[i, b] + links[0, number]
                    if total < best[b] or (total == best[b] < np.inf and so_far[a] < so_far[parents[i, b]]):
                        best[b], parents[i, b] = total, a
    last = int(np.argmin(best))
    if best[last] == np.inf:
        return np.empty(0, dtype=np.int64)
    chain = np.empty(count, dtype=np.int64)
    for i in range(count - 1, -1, -1):
        chain[i] = last
        last = parents[i, last]
    return chain


@njit(cache=True, nogil=True)
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
    frame, near = np.empty((3, 3)), guides[0].copy()
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
            turn_hand(shape, aim, rotations[i], near, joints[i], frame)
        if np.isnan(joints[i].sum()):
            near[:4], near[5] = guides[i, :4], guides[i, 5]
            is_found[i], joints[i] = nearby_joints(shape, positions[i], rotations[i], near)
    return joints, is_found
