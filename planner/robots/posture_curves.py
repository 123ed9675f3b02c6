"""The samples of one tool pose, and the curves of them that an arm with joints to spare has there. Compiled."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.chain import Chain, Scratch, forward
from planner.robots.newton import set_rows, set_step, solve

SAMPLES_MAX = 128
"""Samples at each pose."""

_APART = 0.2
"""Samples of one pose differ by at least this in some joint (rad, m)."""

_STRIDE, _STRIDE_MIN = 0.3, 0.05
"""Largest change of a joint from one sample of a curve to the next, and the least worth a sample (rad, m)."""


class Samples(NamedTuple):
    """The samples of one pose, while they are collected.

    Attributes:
        joints: one in each row, shape (m, n).
        taken: the number of samples, shape (1,).
        joint_count: how many joints, from the first, count: samples do not differ in the others alone.
    """

    joints: FloatArray
    taken: NDArray[np.int64]
    joint_count: int


@kernel
def spread(
    chain: Chain,
    periods: FloatArray,
    point: FloatArray,
    rotation: FloatArray,
    rows: int,
    free: int,
    first: int,
    samples: Samples,
    scratch: Scratch,
) -> None:
    """Add the samples that one and its successors lead to while the tool rests.

    Args:
        chain: the arm.
        periods: what each joint may be off without any difference, see `posture_samples`.
        point: the tool's position, shape (3,).
        rotation: its rotation, shape (3, 3).
        rows: what of the pose is required.
        free: how many joints more than that the arm has.
        first: the sample to begin with, one of the last.
        samples: the samples.
        scratch: working memory.
    """
    if free == 1:
        for sign in (-1.0, 1.0):
            _walk(chain, periods, point, rotation, rows, sign, first, samples, scratch)
        return
    joints, ways, at = np.empty(len(periods)), np.zeros(len(periods)), first
    while free > 1 and at < samples.taken[0] < len(samples.joints):
        for number in range(2 * free):
            _set_ways(number // 2, 1.0 if number % 2 else -1.0, ways[: samples.joint_count])
            joints[:] = samples.joints[at]
            if _go_aside(chain, periods, point, rotation, rows, ways, joints, samples, scratch):
                add(chain, periods, joints, samples)
        at += 1


@kernel
def _walk(
    chain: Chain,
    periods: FloatArray,
    point: FloatArray,
    rotation: FloatArray,
    rows: int,
    sign: float,
    first: int,
    samples: Samples,
    scratch: Scratch,
) -> None:
    """Add the samples along a curve, one way from a sample on it."""
    joints, ways, before = samples.joints[first].copy(), np.zeros(len(periods)), np.empty(len(periods))
    _set_ways(0, sign, ways[: samples.joint_count])
    while samples.taken[0] < len(samples.joints):
        before[:] = joints
        if not _go_aside(chain, periods, point, rotation, rows, ways, joints, samples, scratch):
            break
        add(chain, periods, joints, samples)
        for k in range(samples.joint_count):
            ways[k] = joints[k] - before[k]


@kernel
def _set_ways(number: int, sign: float, ways: FloatArray) -> None:
    """Set a direction in the space of the joints: any that differ will do."""
    for k in range(len(ways)):
        ways[k] = sign * math.cos(1.0 + 2.3 * k + 3.7 * number)


@kernel
def _go_aside(
    chain: Chain,
    periods: FloatArray,
    point: FloatArray,
    rotation: FloatArray,
    rows: int,
    ways: FloatArray,
    joints: FloatArray,
    samples: Samples,
    scratch: Scratch,
) -> bool:
    """Bring joints to the next new sample in a direction; return whether there is one."""
    return bool(
        _step_aside(chain, point, rotation, rows, ways, joints, scratch)
        and not is_alike(periods, samples, joints, samples.joint_count, _APART)
        and solve(chain, point, rotation, rows, joints, scratch)
        and not is_alike(periods, samples, joints, samples.joint_count, _APART)
    )


@kernel
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
        scratch.errors[row] = 0.0
        for k in range(len(joints)):
            scratch.errors[row] += scratch.rows[row, k] * ways[k]
    scratch.is_held[:] = False
    set_step(rows, 1e-10, scratch)
    longest = 0.0
    for k in range(len(joints)):
        scratch.step[k] = ways[k] - scratch.step[k]
        longest = max(longest, abs(scratch.step[k]))
    if longest < 1e-3:
        return False
    share = _STRIDE / longest
    for k in range(len(joints)):
        if not chain.turns[k]:
            step = scratch.step[k]
            room = chain.high[k] - joints[k] if step > 0.0 else joints[k] - chain.low[k]
            share = min(share, room / max(abs(step), 1e-12))
    for k in range(len(joints)):
        joints[k] += share * scratch.step[k]
    return bool(share * longest >= _STRIDE_MIN)


@kernel
def add(chain: Chain, periods: FloatArray, joints: FloatArray, samples: Samples) -> bool:
    """Add joints, and those whole turns away from them, to the samples; return whether they are new."""
    first = samples.taken[0]
    _add_one(periods, joints, samples)
    at, other = first, np.empty(len(joints))
    while at < samples.taken[0]:
        for k in range(samples.joint_count):
            if not chain.turns[k] or periods[k] > 0.0:
                continue
            for turn in (-math.tau, math.tau):
                other[:] = samples.joints[at]
                other[k] += turn
                if chain.low[k] <= other[k] <= chain.high[k]:
                    _add_one(periods, other, samples)
        at += 1
    return bool(samples.taken[0] > first)


@kernel
def _add_one(periods: FloatArray, joints: FloatArray, samples: Samples) -> None:
    number = samples.taken[0]
    if number < len(samples.joints) and not is_alike(periods, samples, joints, samples.joint_count, _APART):
        samples.joints[number] = joints
        samples.taken[0] += 1


@kernel
def is_alike(periods: FloatArray, samples: Samples, joints: FloatArray, count: int, apart: float) -> bool:
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
