"""Samples of an arm's joints at tool poses, from its reach map, for joint paths. Compiled.

Newton's method leads from the postures in a pose's cell and in the cells beside it to the pose, first with the roll
left free; then the last joint turns to the roll, where it turns about the approach axis. The fingers of a gripper are
alike, so a hand that is rolled by half a turn more takes the pose too. Arms with more joints than the pose has demands
have curves of postures there: these are followed both ways from every posture found.

Where the last joint's axis goes through the tool's point, nothing but the roll depends on it. Such an arm has the same
samples for all rolls: `axis_samples` finds them, `planner.robots.posture_samples` turns their hands.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.chain import AXIS, PITCH, WHOLE, Chain, Scratch, forward, scratch_for
from planner.robots.hand_roll import gives_roll, roll_between, roll_left, turn_to_roll
from planner.robots.joint_chain import ELBOW_CLEAR_M, ELBOW_COST, LIMIT_COST, NEAR_LIMIT
from planner.robots.newton import EXACT_M, solve
from planner.robots.posture_curves import SAMPLES_MAX, Samples, add, is_alike, spread
from planner.robots.reach_map import ReachMap, approach_of, cell_of, decode

_TRIED = 0.3
"""A start is not tried where another one has led to joints so near to it (rad, m)."""

_NEAR = 0.6
"""The same for the samples found so far: from a cell away Newton's method mostly leads to their curve again."""

_SAME = 0.1
"""A start has led to no other samples where another one has led to joints so near (rad, m)."""

_ROLLS, _ROLL_STEP = 3, math.pi / 6.0
"""Samples to either side of the roll that is wanted, where it is free, and what they differ by (rad)."""

_ROLL_COST = 0.1
"""Cost of a roll by its squared distance from the one that is wanted, where it is free."""

_ROUNDS = 2
"""Times an arm is brought back to its place after its last joint has turned: the tool may be beside that axis."""


@kernel
def posture_samples(
    chain: Chain, known: ReachMap, periods: FloatArray, points: FloatArray, rotations: FloatArray, floor: float
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
    scratch, most = scratch_for(count), 1
    for i in range(len(points)):
        samples = Samples(joints[i], np.zeros(1, dtype=np.int64), count)
        _collect(chain, known, periods, points[i], rotations[i], samples, scratch)
        for number in range(samples.taken[0]):
            forward(chain, joints[i, number], scratch)
            cost = limit_cost(chain, periods, joints[i, number], count) + _elbow_cost(floor, scratch)
            if chain.rows == PITCH:
                off = roll_left(rotations[i], True, scratch.frame)
                off -= math.pi * math.floor(off / math.pi + 0.5)
                cost += _ROLL_COST * off * off
            costs[i, number] = cost
        most = max(most, samples.taken[0])
    return joints[:, :most].copy(), costs[:, :most].copy()


@kernel
def axis_samples(
    chain: Chain, known: ReachMap, periods: FloatArray, points: FloatArray, rotations: FloatArray, floor: float
) -> tuple[FloatArray, FloatArray]:
    """Return samples of the joints that bring the tool to each point and approach axis, whatever its roll.

    The arm's last joint gives the roll and nothing else. See `posture_samples`; the costs lack those of limits.
    """
    count = len(chain.low)
    joints, costs = np.zeros((len(points), SAMPLES_MAX, count)), np.full((len(points), SAMPLES_MAX), np.inf)
    scratch, most = scratch_for(count), 1
    for i in range(len(points)):
        samples = Samples(joints[i], np.zeros(1, dtype=np.int64), count - 1)
        _collect(chain, known, periods, points[i], rotations[i], samples, scratch)
        for number in range(samples.taken[0]):
            forward(chain, joints[i, number], scratch)
            costs[i, number] = _elbow_cost(floor, scratch)
        most = max(most, samples.taken[0])
    return joints[:, :most].copy(), costs[:, :most].copy()


@kernel
def limit_cost(chain: Chain, periods: FloatArray, joints: FloatArray, count: int) -> float:
    """Return what a sample costs for how near the first joints are to a limit."""
    slack = np.inf
    for k in range(count):
        if periods[k] == 0.0:
            room = min(joints[k] - chain.low[k], chain.high[k] - joints[k])
            slack = min(slack, room / min(NEAR_LIMIT, 0.1 * (chain.high[k] - chain.low[k])))
    tight = max(1.0 - slack, 0.0)
    return LIMIT_COST * tight * tight


@kernel
def _elbow_cost(floor: float, scratch: Scratch) -> float:
    """Return what a sample costs for joints between shoulder and hand that are low; `forward` has set their places."""
    lowest = np.inf
    for k in range(2, len(scratch.places) - 1):
        lowest = min(lowest, scratch.places[k, 2])
    low = max(floor + ELBOW_CLEAR_M - lowest, 0.0)
    return ELBOW_COST * low * low


@kernel
def _collect(
    chain: Chain,
    known: ReachMap,
    periods: FloatArray,
    point: FloatArray,
    rotation: FloatArray,
    samples: Samples,
    scratch: Scratch,
) -> None:
    """Collect the samples of a pose from the postures in its cell and in those beside it.

    Samples of which the last joint does not count are those of the point and the approach axis.
    """
    grid, count = known.grid, len(periods)
    approach, start, place = approach_of(grid, rotation[:, 0]), np.empty(count), np.empty(3)
    alike = count - 1 if gives_roll(chain) else count
    tried = Samples(np.empty((SAMPLES_MAX, count)), np.zeros(1, dtype=np.int64), alike)
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
            if tried.taken[0] == SAMPLES_MAX or is_alike(periods, tried, start, alike, _TRIED):
                continue
            if is_alike(periods, samples, start, alike, _NEAR):
                continue
            if chain.rows != WHOLE and not solve(chain, point, rotation, chain.rows, start, scratch):
                continue
            if is_alike(periods, tried, start, alike, _SAME):
                continue
            tried.joints[tried.taken[0]] = start
            tried.taken[0] += 1
            if samples.joint_count == count:
                _collect_rolled(chain, periods, point, rotation, start, samples, scratch)
                continue
            first = samples.taken[0]
            if add(chain, periods, start, samples):
                spread(chain, periods, point, rotation, AXIS, count - 1 - AXIS, first, samples, scratch)


@kernel
def _collect_rolled(
    chain: Chain,
    periods: FloatArray,
    point: FloatArray,
    rotation: FloatArray,
    start: FloatArray,
    samples: Samples,
    scratch: Scratch,
) -> None:
    """Collect the samples of a whole pose, or one rolled by half a turn, that a posture leads to."""
    count = len(periods)
    rows = PITCH if chain.rows == PITCH else WHOLE
    free = count - rows - (1 if rows == PITCH and gives_roll(chain) else 0)
    rolls = _ROLLS if chain.rows == PITCH and gives_roll(chain) else 0
    joints, rolled = np.empty(count), rotation.copy()
    for _ in range(2):
        for roll in range(-rolls, rolls + 1):
            joints[:] = start
            first = samples.taken[0]
            if _take_pose(chain, point, rolled, roll * _ROLL_STEP, joints, scratch) and add(
                chain, periods, joints, samples
            ):
                spread(chain, periods, point, rolled, rows, free, first, samples, scratch)
        rolled[:, 1:] *= -1.0


@kernel
def _take_pose(
    chain: Chain, point: FloatArray, rotation: FloatArray, more: float, joints: FloatArray, scratch: Scratch
) -> bool:
    """Bring joints to a pose, rolled by an angle more where the roll is free; return whether they take it."""
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


_STEEP = 0.7
"""Sine of the pitch of an approach from which its level direction is not certain enough to build on."""

_TURNS = (0.0, -math.tau, math.tau)
"""Whole turns by which a last joint of more than one turn may be off (rad)."""


def gives_roll_alone(chain: Chain) -> bool:
    """Return whether the last joint changes the hand's roll and neither the tool's point nor its approach axis."""
    beside_m = math.hypot(float(chain.tool_offset[0]), float(chain.tool_offset[1]))
    return chain.rows == AXIS and beside_m <= EXACT_M and gives_roll(chain) and _is_along(chain)


def _is_along(chain: Chain) -> bool:
    return math.hypot(float(chain.tool_rotation[0, 0]), float(chain.tool_rotation[1, 0])) <= EXACT_M


@kernel
def unrolled(rotations: FloatArray) -> FloatArray:
    """Return rotations with the same x axes, shape (n, 3, 3), and rolls that depend on these alone."""
    found = np.empty((len(rotations), 3, 3))
    for i in range(len(rotations)):
        # No negative zeros: equal axes are to be equal bytes.
        x, y, z = rotations[i, 0, 0] + 0.0, rotations[i, 1, 0] + 0.0, rotations[i, 2, 0] + 0.0
        ax, ay, az = (0.0, -z, y) if abs(z) > _STEEP else (-y, x, 0.0)  # across the axis, with x or with z
        length = math.sqrt(ax * ax + ay * ay + az * az)
        ax, ay, az = ax / length, ay / length, az / length
        found[i, 0, 0], found[i, 1, 0], found[i, 2, 0] = x, y, z
        found[i, 0, 1], found[i, 1, 1], found[i, 2, 1] = ax, ay, az
        found[i, 0, 2], found[i, 1, 2], found[i, 2, 2] = y * az - z * ay, z * ax - x * az, x * ay - y * ax
    return found


@kernel
def rolled_samples(
    chain: Chain, periods: FloatArray, rotations: FloatArray, joints: FloatArray, costs: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return samples at whole poses.

    Args:
        chain: the arm.
        periods: what each joint may be off without any difference, see `posture_samples`.
        rotations: the poses' rotations, shape (k, 3, 3).
        joints: the samples of their points and axes, shape (k, m, n).
        costs: their costs, shape (k, m); infinite where there is no sample.

    Returns:
        Joints and costs in the same form, at least one a pose.
    """
    poses, size, count = joints.shape
    found = np.zeros((poses, 6 * size, count))
    taken, scratch, most = np.full((poses, 6 * size), np.inf), scratch_for(count), 1
    last, turning = count - 1, np.empty(count)
    middle = 0.5 * (chain.low[last] + chain.high[last])
    for i in range(poses):
        number = 0
        for each in range(size):
            if costs[i, each] == np.inf:
                continue
            turning[:] = joints[i, each]
            forward(chain, turning, scratch)
            roll = roll_between(scratch.frame, rotations[i, :, 1])
            level = turning[last] + (roll if chain.tool_rotation[2, 0] > 0.0 else -roll)
            for half in range(2):
                rolled = level + math.pi * half
                rolled -= math.tau * math.floor((rolled - middle) / math.tau + 0.5)
                for turn in _TURNS:
                    turning[last] = rolled + turn
                    is_within = chain.low[last] <= turning[last] <= chain.high[last]
                    if is_within and (turn == 0.0 or periods[last] == 0.0):
                        found[i, number] = turning
                        taken[i, number] = costs[i, each] + limit_cost(chain, periods, turning, count)
                        number += 1
        most = max(most, number)
    return found[:, :most].copy(), taken[:, :most].copy()
