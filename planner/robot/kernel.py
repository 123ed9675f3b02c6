"""Can the arm bring its tool to this point, pointing this way? In closed form, compiled.

The naive way is numerical inverse kinematics: a millisecond a question, and no answer when it fails
to converge. But lock the shoulder's pan and the arm of a PR2 is a textbook exercise. With the
approach axis a, the wrist stands at W = tool - tool_length * a, and in the panned shoulder's frame

    (u, v, w) = Rz(-pan) W - (offset, 0, 0)
    cos elbow = (u2 + v2 + w2 - upper2 - fore2) / (2 upper fore),     elbow <= 0
    sin roll  = -v / (fore |sin elbow|),                              two branches
    lift      = atan2(B, A) - atan2(w, u),   A = upper + fore cos elbow,   B = fore cos roll |sin elbow|
    cos wrist = forearm . a,                                          wrist <= 0

while forearm and wrist roll are continuous and can always be met. So the question is whether some pan
leaves all five joints within their limits.

- The elbow's limits, and |sin roll| <= 1, bound cos(pan - bearing of W) by a linear and a quadratic
  inequality: the pans that are possible at all are a few *arcs*, found exactly.
- An arc is walked by an angle theta from 0 to pi: pan = middle - half cos(theta). The branches usually
  meet at the arc's ends, where |sin roll| is 1, and there pan has a square root's infinite slope; in
  theta all is smooth, and with theta from -pi to 0 for the second branch the two form a closed curve.
- *slack* is the least distance from all other limits, taken as the sine of an angle so that
  walking costs no arc functions. It is sampled for both branches at once, and from every promising
  peak among the samples climbed; the answer is yes as soon as it is not negative.

A yes is therefore always right: the theta where the walk stopped is a witness. A no may be wrong
only where the set of good pans is narrower than the climb can find.

Lengths in m, angles in rad, everything in the shoulder's frame: parallel to the base, its origin on
the pan axis at the height of the lift axis. The arm is a left one (see `planner.robot.arm`).

The compiled code is cached on disk, file by file, and does not notice when a function or number that it
uses from *another* file changes: so the arm's numbers are arguments, and whoever changes this file
should delete the caches (``__pycache__``) of its importers too.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from planner.geometry.pose import BoolArray, FloatArray
from planner.robot.arm import ArmShape, Sector

SAMPLES = 8
"""Samples for each branch of the elbow along an arc."""

PROMISING = -0.35
"""A sample whose slack is less than this is not worth climbing from."""

FINEST = 1e-4
"""The climb ends when its step along the curve is smaller than this (rad)."""

STEEPEST = 3.0
"""A climb ends when even a slack growing this fast would stay negative."""

NEARBY = 0.15
"""How far beside the pan that served last another is tried (rad)."""

MOST_ARCS = 8


@njit(cache=True, nogil=True)
def shape_of(numbers: FloatArray) -> ArmShape:
    """The arm whose lengths and limits are these, one after the other (see `planner.robot.arm.numbers_of`).

    To hand a kernel a tuple of so many numbers costs more than what some kernels do.
    """
    n = numbers
    return ArmShape(
        n[0],
        n[1],
        n[2],
        n[3],
        n[4],
        n[5],
        n[6],
        Sector(n[7], n[8], n[9], n[10], n[11], n[12]),
        Sector(n[13], n[14], n[15], n[16], n[17], n[18]),
        Sector(n[19], n[20], n[21], n[22], n[23], n[24]),
        Sector(n[25], n[26], n[27], n[28], n[29], n[30]),
        Sector(n[31], n[32], n[33], n[34], n[35], n[36]),
    )


class Aim(NamedTuple):
    """Where the wrist's centre must be (m) and the unit vector along which the tool points."""

    x: float
    y: float
    z: float
    ax: float
    ay: float
    az: float


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def aim_at(shape: ArmShape, x: float, y: float, z: float, ax: float, ay: float, az: float) -> Aim:
    """The aim that brings the tool to (x, y, z) along the axis (ax, ay, az)."""
    return Aim(x - shape.tool * ax, y - shape.tool * ay, z - shape.tool * az, ax, ay, az)


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def is_within_length(shape: ArmShape, aim: Aim) -> bool:
    """Whether the wrist is no further from the lift axis than the arm is long; limits aside."""
    outward = math.hypot(aim.x, aim.y) - shape.offset
    length = shape.upper + shape.fore
    return outward * outward + aim.z * aim.z <= length * length


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def is_within_height(shape: ArmShape, aim: Aim) -> bool:
    """Whether the wrist is no higher than the forearm could stick up from the highest elbow, and no lower; roughly."""
    highest = shape.fore - shape.upper * shape.lift.sin_low
    lowest = -shape.fore - shape.upper * shape.lift.sin_high
    return lowest <= aim.z <= highest


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def pan_arcs(shape: ArmShape, aim: Aim, arcs: FloatArray) -> int:
    """Find the pans within limits for which elbow and roll have a solution, the elbow within limits.

    Args:
        shape: the arm.
        aim: where the wrist must be.
        arcs: shape (MOST_ARCS, 2), overwritten with the middle and half width of each arc (rad).

    Returns:
        How many arcs there are.
    """
    distance = max(math.hypot(aim.x, aim.y), 1e-9)
    reach_2 = distance * distance + aim.z * aim.z + shape.offset * shape.offset
    swing = 2.0 * shape.offset * distance
    bones_2 = shape.upper * shape.upper + shape.fore * shape.fore
    bones = 2.0 * shape.upper * shape.fore
    # cos(elbow) = level - slope * c with c = cos(pan - bearing): linear in c.
    level, slope = (reach_2 - bones_2) / bones, swing / bones
    lowest = max((level - shape.elbow.cos_high) / slope, -1.0)
    highest = min((level - shape.elbow.cos_low) / slope, 1.0)
    if lowest > highest:
        return 0
    # |sin(roll)| <= 1 is p c^2 + 2 q c + r >= 0, and p > 0: c lies outside of the roots.
    fore_2, distance_2 = shape.fore * shape.fore, distance * distance
    p = distance_2 - fore_2 * slope * slope
    q = fore_2 * level * slope
    r = fore_2 * (1.0 - level * level) - distance_2
    bearing = math.atan2(aim.y, aim.x)
    if q * q <= p * r:
        return _add_band(shape.pan, bearing, lowest, highest, arcs, 0)
    root = math.sqrt(q * q - p * r)
    count = _add_band(shape.pan, bearing, max(lowest, (root - q) / p), highest, arcs, 0)
    return _add_band(shape.pan, bearing, lowest, min(highest, (-root - q) / p), arcs, count)


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def _add_band(limits: Sector, bearing: float, lowest: float, highest: float, arcs: FloatArray, count: int) -> int:
    """Add the arcs where cos(pan - bearing) is from lowest to highest; returns the new count."""
    if lowest > highest:
        return count
    near, far = math.acos(highest), math.acos(lowest)
    if near == 0.0:
        return _add_arc(limits, bearing - far, bearing + far, arcs, count)
    count = _add_arc(limits, bearing + near, bearing + far, arcs, count)
    return _add_arc(limits, bearing - far, bearing - near, arcs, count)


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def _add_arc(limits: Sector, start: float, end: float, arcs: FloatArray, count: int) -> int:
    """Add what lies within the limits of an arc, whole turns allowed; returns the new count."""
    for turn in (-math.tau, 0.0, math.tau):
        low, high = max(start + turn, limits.low), min(end + turn, limits.high)
        if low <= high and count < MOST_ARCS:
            arcs[count, 0], arcs[count, 1] = 0.5 * (low + high), 0.5 * (high - low)
            count += 1
    return count


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def slack_within(limits: Sector, cos: float, sin: float) -> float:
    """The sine of the angle by which a direction lies within limits; negative outside of them."""
    above = sin * limits.cos_low - cos * limits.sin_low
    below = cos * limits.sin_high - sin * limits.cos_high
    return min(above, below) if limits.high - limits.low <= math.pi else max(above, below)


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def slacks(shape: ArmShape, aim: Aim, pan: float) -> tuple[float, float]:
    """The least slack of lift, roll, elbow and wrist at a pan, for cos(roll) >= 0 and for cos(roll) <= 0."""
    cos_pan, sin_pan = math.cos(pan), math.sin(pan)
    u, v, w = cos_pan * aim.x + sin_pan * aim.y - shape.offset, cos_pan * aim.y - sin_pan * aim.x, aim.z
    bones_2 = shape.upper * shape.upper + shape.fore * shape.fore
    cos_elbow = (u * u + v * v + w * w - bones_2) / (2.0 * shape.upper * shape.fore)
    bent = 1.0 - cos_elbow * cos_elbow
    if bent <= 0.0:
        return -1.0, -1.0
    sin_elbow = -math.sqrt(bent)
    sin_roll = v / (shape.fore * sin_elbow)
    rest = 1.0 - sin_roll * sin_roll
    elbow = slack_within(shape.elbow, cos_elbow, sin_elbow)
    if rest < 0.0 or elbow < 0.0:
        return -1.0, -1.0
    cos_roll = math.sqrt(rest)
    a, b = shape.upper + shape.fore * cos_elbow, -shape.fore * cos_roll * sin_elbow
    ahead, left = cos_pan * aim.ax + sin_pan * aim.ay, cos_pan * aim.ay - sin_pan * aim.ax
    inside = min(elbow, slack_within(shape.roll, cos_roll, sin_roll))
    outside = min(elbow, slack_within(shape.roll, -cos_roll, sin_roll))
    return (
        min(inside, _lift_and_wrist_slack(shape, (u, v, w), (ahead, left, aim.az), a, b)),
        min(outside, _lift_and_wrist_slack(shape, (u, v, w), (ahead, left, aim.az), a, -b)),
    )


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def _lift_and_wrist_slack(
    shape: ArmShape, wrist: tuple[float, float, float], axis: tuple[float, float, float], a: float, b: float
) -> float:
    """The lesser slack of lift and wrist for a wrist's centre and an axis seen from the panned shoulder."""
    u, v, w = wrist
    length_2 = a * a + b * b
    cos_lift, sin_lift = (a * u + b * w) / length_2, (b * u - a * w) / length_2
    along = (u - shape.upper * cos_lift) * axis[0] + v * axis[1] + (w + shape.upper * sin_lift) * axis[2]
    cos_wrist = min(max(along / shape.fore, -1.0), 1.0)
    sin_wrist = -math.sqrt(1.0 - cos_wrist * cos_wrist)
    lift = slack_within(shape.lift, cos_lift, sin_lift)
    return min(lift, slack_within(shape.wrist, cos_wrist, sin_wrist))


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def pan_on(arc: FloatArray, theta: float) -> float:
    """The pan at an angle of the closed curve over an arc (middle, half width)."""
    pan: float = arc[0] - arc[1] * math.cos(theta)
    return pan


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def _climbed(
    shape: ArmShape, aim: Aim, arc: FloatArray, branch: int, theta: float, here: float, step: float
) -> tuple[float, float]:
    """The slack and theta of a peak within a step of theta, or of the first place that is good enough."""
    while here < 0.0 and step > FINEST and here > -STEEPEST * step:
        step *= 0.5
        left = slacks(shape, aim, pan_on(arc, theta - step))[branch]
        right = slacks(shape, aim, pan_on(arc, theta + step))[branch]
        if max(left, right) > here:
            theta += step if right >= left else -step
            here = max(left, right)
    return here, theta


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def witness(shape: ArmShape, aim: Aim, arcs: FloatArray) -> tuple[int, float]:
    """An arc and theta at which every joint is within its limits; arc -1 if there is none.

    `arcs` is overwritten with the arcs (see `pan_arcs`).
    """
    step = math.pi / SAMPLES
    for arc in range(pan_arcs(shape, aim, arcs)):
        here, after = (-1.0, -1.0), slacks(shape, aim, pan_on(arcs[arc], 0.5 * step))
        for sample in range(SAMPLES):
            theta = (sample + 0.5) * step
            before, here, after = here, after, (-1.0, -1.0)
            if sample + 1 < SAMPLES:
                after = slacks(shape, aim, pan_on(arcs[arc], theta + step))
            for branch in (0, 1):
                slack = here[branch]
                if slack > PROMISING and slack >= before[branch] and slack >= after[branch]:
                    peak, at = _climbed(shape, aim, arcs[arc], branch, theta, slack, step)
                    if peak >= 0.0:
                        at = math.pi - abs(math.pi - abs(at))
                        return arc, at if branch == 0 else -at
    return -1, 0.0


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def is_reachable(shape: ArmShape, aim: Aim, arcs: FloatArray) -> bool:
    """Whether the arm can take this aim with every joint within its limits."""
    return witness(shape, aim, arcs)[0] >= 0


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def ring_slack(shape: ArmShape, aim: Aim, radius: float, pan: float, branch: float) -> tuple[float, int]:
    """The least slack at one pan and branch (cos(roll) of its sign) of an aim and four on a circle round it.

    And of which: 0 is the aim itself, the others as by `beside`.
    """
    cos_pan, sin_pan = math.cos(pan), math.sin(pan)
    bones_2 = shape.upper * shape.upper + shape.fore * shape.fore
    bones = 2.0 * shape.upper * shape.fore
    u, v, w = cos_pan * aim.x + sin_pan * aim.y - shape.offset, cos_pan * aim.y - sin_pan * aim.x, aim.z
    axis = (cos_pan * aim.ax + sin_pan * aim.ay, cos_pan * aim.ay - sin_pan * aim.ax, aim.az)
    along, across = radius * cos_pan, radius * sin_pan
    least, worst = 1.0, 0
    moves = ((0.0, 0.0), (along, -across), (-along, across), (across, along), (-across, -along))
    for number, (du, dv) in enumerate(moves):
        x, y = u + du, v + dv
        cos_elbow = (x * x + y * y + w * w - bones_2) / bones
        bent = 1.0 - cos_elbow * cos_elbow
        sin_elbow = -math.sqrt(max(bent, 1e-12))
        sin_roll = y / (shape.fore * sin_elbow)
        rest = 1.0 - sin_roll * sin_roll
        cos_roll = branch * math.sqrt(max(rest, 0.0))
        a, b = shape.upper + shape.fore * cos_elbow, -shape.fore * cos_roll * sin_elbow
        joints = min(slack_within(shape.elbow, cos_elbow, sin_elbow), slack_within(shape.roll, cos_roll, sin_roll))
        hand = _lift_and_wrist_slack(shape, (x, y, w), axis, a, b)
        slack = min(min(joints, hand), min(bent, rest))
        least, worst = (slack, number) if slack < least else (least, worst)
    return least, worst


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def beside(aim: Aim, radius: float, number: int) -> Aim:
    """The aim itself (0), or one beside it on a circle: ahead, back, left or right (1 to 4)."""
    dx = radius if number == 1 else -radius if number == 2 else 0.0
    dy = radius if number == 3 else -radius if number == 4 else 0.0
    return Aim(aim.x + dx, aim.y + dy, aim.z, aim.ax, aim.ay, aim.az)


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def is_reachable_near(shape: ArmShape, aim: Aim, arcs: FloatArray, hint: FloatArray) -> bool:
    """The same, trying first the pan that served last, `hint`, shape (1,), which is kept up to date.

    Neighbouring places mostly share a pan, or nearly, and to check one costs a tenth of finding one. A yes is as
    certain.
    """
    for shift in (0.0, NEARBY, -NEARBY):
        pan = min(max(hint[0] + shift, shape.pan.low), shape.pan.high)
        inside, outside = slacks(shape, aim, pan)
        if max(inside, outside) >= 0.0:
            hint[0], hint[1] = pan, 1.0 if inside >= outside else -1.0
            return True
    arc, theta = witness(shape, aim, arcs)
    if arc < 0:
        return False
    hint[0], hint[1] = pan_on(arcs[arc], theta), 1.0 if theta >= 0.0 else -1.0
    return True


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def reachable_batch(shape: ArmShape, points: FloatArray, axes: FloatArray) -> BoolArray:
    """Which tool points and approach axes, each of shape (n, 3), are reachable; shape (n,)."""
    arcs = np.empty((MOST_ARCS, 2))
    answers = np.empty(len(points), dtype=np.bool_)
    for i in range(len(points)):
        aim = aim_at(shape, points[i, 0], points[i, 1], points[i, 2], axes[i, 0], axes[i, 1], axes[i, 2])
        answers[i] = is_reachable(shape, aim, arcs)
    return answers
