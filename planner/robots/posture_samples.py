"""Samples of an arm's joints at tool poses, from its map of postures, for joint paths. Compiled.

Newton's method leads from the postures in a pose's cell and in the cells beside it to the pose, first with the roll
left free; then the last joint turns to the roll, where it turns about the approach axis. The fingers of a gripper are
alike, so a hand that is rolled by half a turn more takes the pose too. Arms with more joints than the pose has demands
have curves of postures there: these are followed both ways from every posture found.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.robots.chain import AXIS, PITCH, WHOLE, Chain, Scratch, forward, scratch_for
from planner.robots.hand_roll import gives_roll, roll_left, turn_to_roll
from planner.robots.joint_chain import ELBOW_CLEAR_M, ELBOW_COST, LIMIT_COST, NEAR_LIMIT
from planner.robots.newton import set_rows, set_step, solve
from planner.robots.posture_map import PostureMap, approach_of, cell_of, decode

SAMPLES_MAX = 128
"""Samples at each pose."""

_APART = 0.2
"""Samples of one pose differ by at least this in some joint (rad, m)."""

_STRIDE, _STRIDE_MIN = 0.3, 0.05
"""Largest change of a joint from one sample of a curve to the next, and the least worth a sample (rad, m)."""

_TRIED = 0.3
"""A start is not tried where another one has led to joints so near to it (rad, m)."""

_ROLLS, _ROLL_STEP = 3, math.pi / 6.0
"""Samples to either side of the roll that is wanted, where it is not asked, and what they differ by (rad)."""

_ROLL_COST = 0.1
"""Cost of a roll by its squared distance from the one that is wanted, where it is not asked."""

_ROUNDS = 2
"""Times an arm is brought back to its place after its last joint has turned: the tool may be beside that axis."""


class Samples(NamedTuple):
    """The samples of one pose, while they are collected.

    Attributes:
        joints: one in each row, shape (m, n).
        costs: their costs, shape (m,); infinite where there is no sample.
        taken: the number of samples, shape (1,).
    """

    joints: FloatArray
    costs: FloatArray
    taken: NDArray[np.int64]


@njit(cache=True, nogil=True)
def posture_samples(
    chain: Chain, known: PostureMap, periods: FloatArray, points: FloatArray, rotations: FloatArray, floor: float
) -> tuple[FloatArray, FloatArray]:
    """Return samples of the joints that bring the tool to each pose.

    Args:
        chain: the arm.
        known: its map.
        periods: what each joint may be off without any difference (rad), 0 where there is no such; shape (n,).
        points: positions, seen from the arm's root, shape (k, 3).
        rotations: rotations, shape (k, 3, 3).
        floor: the height over which elbows should preferably stay, seen from the root.

    Returns:
        The joints, shape (k, m, n), and the samples' costs, shape (k, m): infinite where there is no sample; at least
        one a pose.
    """
    count = len(chain.low)
    joints, costs = np.zeros((len(points), SAMPLES_MAX, count)), np.full((len(points), SAMPLES_MAX), np.inf)
    scratch, most, rolled = scratch_for(count), 1, np.empty((2, 3, 3))
    for i in range(len(points)):
        samples = Samples(joints[i], costs[i], np.zeros(1, dtype=np.int64))
        rolled[0] = rotations[i]
        rolled[1, :, 0], rolled[1, :, 1:] = rotations[i, :, 0], -rotations[i, :, 1:]
        _collect(chain, known, periods, points[i], rolled, samples, scratch)
        for number in range(samples.taken[0]):
            forward(chain, joints[i, number], scratch)
            costs[i, number] = _cost(chain, periods, joints[i, number], rotations[i], floor, scratch)
        most = max(most, samples.taken[0])
    return joints[:, :most].copy(), costs[:, :most].copy()


@njit(cache=True, nogil=True)
def _cost(
    chain: Chain, periods: FloatArray, joints: FloatArray, rotation: FloatArray, floor: float, scratch: Scratch
) -> float:
    """Return what a sample costs: near a limit, with a joint between shoulder and hand low, or rolled otherwise."""
    slack, count = np.inf, len(joints)
    for k in range(count):
        if periods[k] == 0.0:
            room = min(joints[k] - chain.low[k], chain.high[k] - joints[k])
            slack = min(slack, room / min(NEAR_LIMIT, 0.1 * (chain.high[k] - chain.low[k])))
    tight, lowest = max(1.0 - slack, 0.0), np.inf
    for k in range(2, count - 1):
        lowest = min(lowest, scratch.places[k, 2])
    low = max(floor + ELBOW_CLEAR_M - lowest, 0.0)
    cost: float = LIMIT_COST * tight * tight + ELBOW_COST * low * low
    if chain.rows == PITCH:
        off = roll_left(rotation, True, scratch.frame)
        off -= math.pi * math.floor(off / math.pi + 0.5)
        cost += _ROLL_COST * off * off
    return cost


@njit(cache=True, nogil=True)
def _collect(
    chain: Chain,
    known: PostureMap,
    periods: FloatArray,
    point: FloatArray,
    rolled: FloatArray,
    samples: Samples,
    scratch: Scratch,
) -> None:
    """Collect the samples of a pose from the postures in its cell and in those beside it."""
    grid, count = known.grid, len(periods)
    approach, start, joints = approach_of(grid, rolled[0, :, 0]), np.empty(count), np.empty(count)
    rolls = _ROLLS if chain.rows == PITCH and gives_roll(chain) else 0
    tried = Samples(np.empty((SAMPLES_MAX, count)), np.empty(0), np.zeros(1, dtype=np.int64))
    place = np.empty(3)
    for beside in range(7):
        place[:] = point
        if beside:
            place[(beside - 1) // 2] += grid.cell if beside % 2 else -grid.cell
        cell = cell_of(grid, place)
        if cell < 0:
            continue
        entry = cell * len(grid.rotations) + approach
        for number in range(known.starts[entry], known.starts[entry + 1]):
            decode(grid, known.postures[number], start)
            if tried.taken[0] == SAMPLES_MAX or _is_alike(periods, tried, start, count - gives_roll(chain), _TRIED):
                continue
            if chain.rows != WHOLE and not solve(chain, point, rolled[0], chain.rows, start, scratch):
                continue
            tried.joints[tried.taken[0]] = start
            tried.taken[0] += 1
            for half in range(2):
                for roll in range(-rolls, rolls + 1):
                    joints[:] = start
                    first = samples.taken[0]
                    if _take_pose(chain, point, rolled[half], roll * _ROLL_STEP, joints, scratch) and _add(
                        chain, periods, joints, samples
                    ):
                        _spread(chain, periods, point, rolled[half], first, samples, scratch)


@njit(cache=True, nogil=True)
def _take_pose(
    chain: Chain, point: FloatArray, rotation: FloatArray, more: float, joints: FloatArray, scratch: Scratch
) -> bool:
    """Bring joints to a pose, rolled by an angle more where the roll is not asked; return whether they take it."""
    if chain.rows != PITCH:
        if chain.rows == AXIS and not turn_to_roll(chain, rotation, more, joints, scratch) and len(joints) <= WHOLE:
            return False
        return solve(chain, point, rotation, WHOLE, joints, scratch)
    if not gives_roll(chain):
        return True
    for _ in range(_ROUNDS):
        if not turn_to_roll(chain, rotation, more, joints, scratch):
            return False
        if not solve(chain, point, rotation, PITCH, joints, scratch):
            return False
    return True


@njit(cache=True, nogil=True)
def _spread(
    chain: Chain,
    periods: FloatArray,
    point: FloatArray,
    rotation: FloatArray,
    first: int,
    samples: Samples,
    scratch: Scratch,
) -> None:
    """Add the samples that the first new one and its successors lead to while the tool rests."""
    rows = PITCH if chain.rows == PITCH else WHOLE
    count = len(periods)
    free = count - rows - (1 if rows == PITCH and gives_roll(chain) else 0)
    joints, ways, at = np.empty(count), np.empty(count), first
    while free > 0 and at < samples.taken[0] < SAMPLES_MAX:
        for way in range(2 * free):
            for k in range(count):
                ways[k] = math.cos(1.0 + 2.3 * k + 3.7 * (way // 2)) * (1.0 if way % 2 else -1.0)
            joints[:] = samples.joints[at]
            if (
                _step_aside(chain, point, rotation, rows, ways, joints, scratch)
                and not _is_alike(periods, samples, joints, count, _APART)
                and solve(chain, point, rotation, rows, joints, scratch)
            ):
                _add(chain, periods, joints, samples)
        at += 1


@njit(cache=True, nogil=True)
def _step_aside(
    chain: Chain,
    point: FloatArray,
    rotation: FloatArray,
    rows: int,
    ways: FloatArray,
    joints: FloatArray,
    scratch: Scratch,
) -> bool:
    """Move joints the way that keeps the tool at its pose and is nearest to a given one, within their limits.

    Returns:
        Whether they had room to move.
    """
    forward(chain, joints, scratch)
    set_rows(chain, point, rotation, rows, scratch)
    for row in range(rows):
        scratch.errors[row] = (scratch.rows[row] * ways).sum()
    scratch.is_held[:] = False
    set_step(rows, 1e-10, scratch)
    step = ways - scratch.step
    longest = np.abs(step).max()
    if longest < 1e-3:
        return False
    share = _STRIDE / longest
    for k in range(len(joints)):
        if not chain.turns[k]:
            room = chain.high[k] - joints[k] if step[k] > 0.0 else joints[k] - chain.low[k]
            share = min(share, room / max(abs(step[k]), 1e-12))
    joints += share * step
    return bool(share * longest >= _STRIDE_MIN)


@njit(cache=True, nogil=True)
def _add(chain: Chain, periods: FloatArray, joints: FloatArray, samples: Samples) -> bool:
    """Add joints, and those whole turns away from them, to the samples; return whether they are new."""
    first = samples.taken[0]
    _add_one(periods, joints, samples)
    at, other = first, np.empty(len(joints))
    while at < samples.taken[0]:
        for k in range(len(joints)):
            for turn in (-math.tau, math.tau):
                other[:] = samples.joints[at]
                other[k] += turn
                if chain.turns[k] and periods[k] == 0.0 and chain.low[k] <= other[k] <= chain.high[k]:
                    _add_one(periods, other, samples)
        at += 1
    return bool(samples.taken[0] > first)


@njit(cache=True, nogil=True)
def _add_one(periods: FloatArray, joints: FloatArray, samples: Samples) -> None:
    number = samples.taken[0]
    if number < SAMPLES_MAX and not _is_alike(periods, samples, joints, len(joints), _APART):
        samples.joints[number] = joints
        samples.taken[0] += 1


@njit(cache=True, nogil=True)
def _is_alike(periods: FloatArray, samples: Samples, joints: FloatArray, count: int, apart: float) -> bool:
    """Return whether the first joints of a sample are all nearer than a distance to given ones."""
    for number in range(samples.taken[0]):
        is_near = True
        for k in range(count):
            off = joints[k] - samples.joints[number, k]
            if periods[k] > 0.0:
                off -= periods[k] * math.floor(off / periods[k] + 0.5)
            if abs(off) >= apart:
                is_near = False
                break
        if is_near:
            return True
    return False
