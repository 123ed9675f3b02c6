"""Newton's method for the joints that bring a tool to a pose. Compiled.

It is damped and has as many rows as the pose has demands: three for the position, then one for the pitch of the
approach axis (arms of five joints and fewer: the heading follows), or two for the axis (arms whose last joint gives the
roll), or three for the whole rotation. Joints at a limit that would leave it are held there.
"""

import math

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import compiled, fast_inlined, fast_kernel, inlined, kernel
from planner.robots.chain import AXIS, PITCH, WHOLE, Chain, Scratch, forward, scratch_for

ITERATIONS_MAX = 20
"""Newton steps before a start is given up."""

EXACT_M = 1e-6
"""Largest distance of a solution from its pose (m); angles count by the arm's length scale."""

STEP_MAX = 0.5
"""Largest change of a joint in one step (rad, m)."""

PATIENCE, PROGRESS = 4, 0.6
"""A start is given up where the error has not fallen to this share of itself within so many steps."""

HOPELESS = 0.5
"""A start is given up where more than this share of the error is left even if the arm moves as its Jacobian says."""


@fast_kernel
def _pitch_row(point: FloatArray, rotation: FloatArray, scratch: Scratch) -> tuple[float, float, float]:
    """Return how far the pitch is from the wanted one (rad), and the horizontal axis (x, y) that raises it.

    The pitch is measured in the upright plane at a right angle to the second joint's axis, so that it may pass
    straight down.
    """
    hx, hy = scratch.axes[1, 0], scratch.axes[1, 1]
    length = math.hypot(hx, hy)
    if length < 1e-9:
        return 0.0, 0.0, 0.0
    hx, hy = hx / length, hy / length
    if hy * point[0] - hx * point[1] < 0.0:
        hx, hy = -hx, -hy
    ahead = scratch.frame[0, 0] * hy - scratch.frame[1, 0] * hx
    wanted = math.atan2(-rotation[2, 0], math.hypot(rotation[0, 0], rotation[1, 0]))
    lacking = wanted - math.atan2(-scratch.frame[2, 0], ahead)
    return lacking - math.tau * math.floor(lacking / math.tau + 0.5), hx, hy


@fast_inlined
def set_rows(chain: Chain, point: FloatArray, rotation: FloatArray, rows: int, scratch: Scratch) -> float:
    """Set the errors and the Jacobian of a pose; return the error's length (m)."""
    errors, jacobian, frame, scale = scratch.errors, scratch.rows, scratch.frame, chain.scale
    joints = len(chain.low)
    for k in range(3):
        errors[k] = point[k] - scratch.point[k]
    tx, ty, tz = 0.0, 0.0, 0.0
    if rows == PITCH:
        lacking, tx, ty = _pitch_row(point, rotation, scratch)
        errors[3] = scale * lacking
    else:
        ex, ey, ez, along = 0.0, 0.0, 0.0, -0.5
        for axis in range(1 if rows == AXIS else 3):
            ax, ay, az = frame[0, axis], frame[1, axis], frame[2, axis]
            wx, wy, wz = rotation[0, axis], rotation[1, axis], rotation[2, axis]
            cx, cy, cz = ay * wz - az * wy, az * wx - ax * wz, ax * wy - ay * wx
            share = 1.0
            if rows == AXIS:
                sine = math.sqrt(cx * cx + cy * cy + cz * cz)
                share = math.atan2(sine, ax * wx + ay * wy + az * wz) / sine if sine > 1e-9 else 1.0
                if sine <= 1e-9 and ax * wx + ay * wy + az * wz < 0.0:
                    cx, cy, cz = math.pi * frame[0, 1], math.pi * frame[1, 1], math.pi * frame[2, 1]
            else:
                share = 0.5
                along += 0.5 * (ax * wx + ay * wy + az * wz)
            ex, ey, ez = ex + share * cx, ey + share * cy, ez + share * cz
        if rows == AXIS:
            errors[3] = scale * (ex * frame[0, 1] + ey * frame[1, 1] + ez * frame[2, 1])
            errors[4] = scale * (ex * frame[0, 2] + ey * frame[1, 2] + ez * frame[2, 2])
        else:
            if along < 0.0:  # more than a quarter turn is left: the cross products are small again near half a turn
                sine = math.sqrt(ex * ex + ey * ey + ez * ez)
                share = math.atan2(sine, along) / sine if sine > 1e-9 else 0.0
                ex, ey, ez = share * ex, share * ey, share * ez
                if sine <= 1e-9:
                    ex, ey, ez = math.pi * frame[0, 0], math.pi * frame[1, 0], math.pi * frame[2, 0]
            errors[3], errors[4], errors[5] = scale * ex, scale * ey, scale * ez
    axes, places = scratch.axes, scratch.places
    px, py, pz = scratch.point[0], scratch.point[1], scratch.point[2]
    lx, ly, lz = scale * frame[0, 1], scale * frame[1, 1], scale * frame[2, 1]
    ux, uy, uz = scale * frame[0, 2], scale * frame[1, 2], scale * frame[2, 2]
    for i in range(joints):
        wx, wy, wz = axes[i, 0], axes[i, 1], axes[i, 2]
        if chain.is_prismatic[i]:
            jacobian[0, i], jacobian[1, i], jacobian[2, i] = wx, wy, wz
            wx, wy, wz = 0.0, 0.0, 0.0
        else:
            dx, dy, dz = px - places[i, 0], py - places[i, 1], pz - places[i, 2]
            jacobian[0, i], jacobian[1, i] = wy * dz - wz * dy, wz * dx - wx * dz
            jacobian[2, i] = wx * dy - wy * dx
        if rows == PITCH:
            jacobian[3, i] = scale * (wx * tx + wy * ty + wz * tz)
        elif rows == AXIS:
            jacobian[3, i] = wx * lx + wy * ly + wz * lz
            jacobian[4, i] = wx * ux + wy * uy + wz * uz
        else:
            jacobian[3, i], jacobian[4, i], jacobian[5, i] = scale * wx, scale * wy, scale * wz
    squared = 0.0
    for k in range(rows):
        squared += errors[k] * errors[k]
    return math.sqrt(squared)


@fast_inlined
def set_step(rows: int, damping: float, scratch: Scratch) -> None:
    """Set the damped least-squares step of the joints; those that are held rest."""
    jacobian, normal, errors, step = scratch.rows, scratch.normal, scratch.errors, scratch.step
    solution = scratch.solution
    joints = len(step)
    for a in range(rows):
        for b in range(a + 1):
            total = damping if a == b else 0.0
            for i in range(joints):
                total += jacobian[a, i] * jacobian[b, i]
            for k in range(b):
                total -= normal[a, k] * normal[b, k]
            # The diagonal holds reciprocals: it only divides.
            normal[a, b] = 1.0 / math.sqrt(max(total, 1e-18)) if a == b else total * normal[b, b]
    for a in range(rows):
        total = errors[a]
        for k in range(a):
            total -= normal[a, k] * solution[k]
        solution[a] = total * normal[a, a]
    for back in range(rows):
        a = rows - 1 - back
        total = solution[a]
        for k in range(a + 1, rows):
            total -= normal[k, a] * solution[k]
        solution[a] = total * normal[a, a]
    for i in range(joints):
        total = 0.0
        for a in range(rows):
            total += jacobian[a, i] * solution[a]
        step[i] = total


@inlined
def hold(joint: int, scratch: Scratch) -> None:
    """Leave a joint where it is in the steps that follow, until the Jacobian is set again."""
    scratch.is_held[joint] = True
    for row in range(len(scratch.errors)):
        scratch.rows[row, joint] = 0.0


@fast_inlined
def _squared_left(rows: int, scratch: Scratch) -> float:
    """Return the square of the error that is left after the step, by the Jacobian (m2)."""
    squared = 0.0
    for row in range(rows):
        left = scratch.errors[row]
        for i in range(len(scratch.step)):
            left -= scratch.rows[row, i] * scratch.step[i]
        squared += left * left
    return squared


@fast_kernel
def solve(
    chain: Chain, point: FloatArray, rotation: FloatArray, rows: int, joints: FloatArray, scratch: Scratch
) -> bool:
    """Return whether Newton's method leads from some joints to a tool pose; the joints are set to where it ends.

    Args:
        chain: the arm.
        point: the tool's position, shape (3,).
        rotation: the tool's axes as columns, shape (3, 3); with `AXIS` and `PITCH` only the first counts.
        rows: what of the pose is required.
        joints: where to begin, shape (n,); within the limits, but for joints that have whole turns.
        scratch: working memory.
    """
    count, before, wait = len(joints), math.inf, 0
    for _ in range(ITERATIONS_MAX):
        forward(chain, joints, scratch)
        error = set_rows(chain, point, rotation, rows, scratch)
        if error <= EXACT_M:
            return _settled(chain, joints)
        wait += 1
        if error <= PROGRESS * before:
            before, wait = error, 0
        elif wait >= PATIENCE:
            return False
        scratch.is_held[:] = False
        for _ in range(count):
            set_step(rows, min(1e-3, 0.02 * error * error) + 1e-12, scratch)
            is_new = False
            for i in range(count):
                if chain.turns[i] or scratch.is_held[i]:
                    continue
                step = scratch.step[i]
                if (step < 0.0 and joints[i] <= chain.low[i]) or (step > 0.0 and joints[i] >= chain.high[i]):
                    hold(i, scratch)
                    is_new = True
            if not is_new:
                break
        if _squared_left(rows, scratch) > (HOPELESS * error) ** 2:
            return False
        longest = 0.0
        for i in range(count):
            longest = max(longest, abs(scratch.step[i]))
        share = min(1.0, STEP_MAX / longest) if longest > 0.0 else 1.0
        for i in range(count):
            joints[i] += share * scratch.step[i]
            if not chain.turns[i]:
                joints[i] = min(max(joints[i], chain.low[i]), chain.high[i])
    return False


@compiled(error_model="numpy")
def _settled(chain: Chain, joints: FloatArray) -> bool:
    """Bring joints that have whole turns within their limits, nearest to the middle; always possible."""
    for i in range(len(joints)):
        if chain.turns[i] and not chain.low[i] <= joints[i] <= chain.high[i]:
            middle = 0.5 * (chain.low[i] + chain.high[i]) if math.isfinite(chain.low[i] + chain.high[i]) else 0.0
            joints[i] -= math.tau * math.floor((joints[i] - middle) / math.tau + 0.5)
    return True


@kernel
def solve_from(
    chain: Chain, points: FloatArray, rotations: FloatArray, rows: int, starts: FloatArray
) -> tuple[BoolArray, FloatArray]:
    """Return which poses Newton's method finds joints for, each from its own start, and the joints.

    Args:
        chain: the arm.
        points: positions, shape (m, 3).
        rotations: rotations, shape (m, 3, 3).
        rows: what of each pose is required.
        starts: joints to begin with, shape (m, n).
    """
    scratch, joints = scratch_for(starts.shape[1]), starts.copy()
    found: NDArray[np.bool_] = np.zeros(len(points), dtype=np.bool_)
    for i in range(len(points)):
        found[i] = solve(chain, points[i], rotations[i], rows, joints[i], scratch)
    return found, joints


@kernel
def followed(
    chain: Chain, is_endless: BoolArray, points: FloatArray, rotations: FloatArray, guides: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Return the joints that Newton's method finds from each guide for its pose, or else from the joints before.

    A hand that is rolled by more than a quarter turn at the first guide stays rolled by half a turn.

    Args:
        chain: the arm.
        is_endless: which joints turn without end, shape (k,).
        points: positions, seen from the arm's root, shape (n, 3).
        rotations: rotations, shape (n, 3, 3).
        guides: joints to be near to, shape (n, k).

    Returns:
        The joints, shape (n, k), those that turn without end as near to the guides as they can be; and whether there
        are any, shape (n,).
    """
    rows = PITCH if chain.rows == PITCH else WHOLE
    scratch, joints, is_found = scratch_for(guides.shape[1]), guides.copy(), np.zeros(len(guides), dtype=np.bool_)
    forward(chain, guides[0], scratch)
    is_over = (scratch.frame[:, 1] * rotations[0, :, 1]).sum() < 0.0
    rotation = np.empty((3, 3))
    for i in range(len(guides)):
        rotation[:] = rotations[i]
        if is_over:
            rotation[:, 1:] *= -1.0
        is_found[i] = solve(chain, points[i], rotation, rows, joints[i], scratch)
        if not is_found[i] and i > 0:
            joints[i] = joints[i - 1]
            is_found[i] = solve(chain, points[i], rotation, rows, joints[i], scratch)
        for k in range(guides.shape[1]):
            if is_endless[k]:
                joints[i, k] += math.tau * math.floor((guides[i, k] - joints[i, k]) / math.tau + 0.5)
    return joints, is_found
