"""Reachability of a tool position and approach axis, in closed form, compiled.

Numerical inverse kinematics would take a millisecond a query, and gives no answer when it fails to converge. But with
the shoulder's pan locked the arm of a PR2 has a closed-form solution. With the approach axis a, the wrist stands at W =
tool - tool_length * a, and in the panned shoulder's frame

    (u, v, w) = Rz(-pan) W - (offset, 0, 0)
    cos elbow = (u2 + v2 + w2 - upper2 - fore2) / (2 upper fore),     elbow <= 0
    sin roll  = -v / (fore |sin elbow|),                              two branches
    lift      = atan2(B, A) - atan2(w, u),   A = upper + fore cos elbow,   B = fore cos roll |sin elbow|
    cos wrist = forearm . a,                                          wrist <= 0

while forearm and wrist roll are continuous and can always be met. The query is then whether some pan leaves all five
joints within their limits.

- The elbow's limits, and |sin roll| <= 1, bound cos(pan - bearing of W) by a linear and a quadratic inequality: the
  feasible pans are a few *arcs*, found exactly (`planner.robots.pr2.pan_arcs`).
- An arc is parametrised by an angle theta from 0 to pi: pan = middle - half cos(theta). The branches usually meet at
  the arc's ends, where |sin roll| is 1, and there pan has a square root's infinite slope; in theta everything is
  smooth, and with theta from -pi to 0 for the second branch the two form a closed curve.
- *slack* is the least distance from all other limits, taken as the sine of an angle so that it needs no arc functions
  (`planner.robots.pr2.joint_slack`). It is sampled for both branches at once, and climbed from every promising peak
  among the samples; the answer is yes as soon as it is not negative.

A yes is therefore always right: the theta where the climb stopped is a witness. A no may be wrong only where the set of
good pans is narrower than the climb can find.

Where all limits are kept, an unreachable pose has no solution to examine. So to find the joint that limits, the pan's
limits are dropped: along the arcs that are then left every joint but the elbow may be outside its limits, and its slack
says by how much. The arm's best try is the pan at which the least of the five slacks is greatest, and the joint with
that least slack is the limiting one.

Lengths are in m, angles in rad, and everything is in the shoulder's frame: parallel to the base, its origin on the pan
axis at the height of the lift axis. The arm is a left arm (see `planner.robots.pr2.arm`).

Numbers in other files are part of the compiled code, so the arm's are arguments (for the cache of compiled code see
`planner.kernel_cache`).
"""

import math

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import fast_kernel, kernel
from planner.robots.pr2.aim import ToolPose, aim_at, is_within_length
from planner.robots.pr2.arm import ArmShape, Sector, sector
from planner.robots.pr2.joint_slack import slack_within, slacks
from planner.robots.pr2.pan_arcs import MOST_ARCS, pan_arcs, pan_on

SAMPLES = 8
"""Samples for each branch of the elbow along an arc."""

PROMISING = -0.35
"""Least slack of a sample from which to climb."""

FINEST = 1e-4
"""Step along the curve at which the climb ends (rad)."""

STEEPEST = 3.0
"""Largest growth of the slack assumed: a climb ends when even this would leave it negative."""

NEARBY = 0.15
"""Distance from the pan that served last at which others are tried (rad)."""


@kernel
def shape_of(numbers: FloatArray) -> ArmShape:
    """Return the arm whose lengths and limits are given as one array (see `planner.robots.pr2.arm.numbers_of`).

    Passing a kernel a tuple of so many numbers costs more than what some kernels do.
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


@fast_kernel
def _climbed(
    shape: ArmShape, aim: ToolPose, arc: FloatArray, branch: int, theta: float, here: float, step: float
) -> tuple[float, float]:
    """Return the slack and theta of a peak within a step of theta, or of the first point that is good enough."""
    while here < 0.0 and step > FINEST and here > -STEEPEST * step:
        step *= 0.5
        left = slacks(shape, aim, pan_on(arc, theta - step))[branch]
        right = slacks(shape, aim, pan_on(arc, theta + step))[branch]
        if max(left, right) > here:
            theta += step if right >= left else -step
            here = max(left, right)
    return here, theta


@fast_kernel
def witness(shape: ArmShape, aim: ToolPose, arcs: FloatArray) -> tuple[int, float]:
    """Return an arc and theta at which every joint is within its limits; arc -1 if there is none.

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


@fast_kernel
def is_reachable(shape: ArmShape, aim: ToolPose, arcs: FloatArray) -> bool:
    """Return whether the arm can take this tool pose with every joint within its limits."""
    return witness(shape, aim, arcs)[0] >= 0


@fast_kernel
def is_reachable_near(shape: ArmShape, aim: ToolPose, arcs: FloatArray, hint: FloatArray) -> bool:
    """Return whether the arm can take this tool pose, trying the pan in `hint`, shape (1,), first.

    `hint` holds the pan that served last and is kept up to date. Neighbouring places mostly share a pan, or nearly, and
    checking a pan costs a tenth of finding one. A yes is as certain as that of `is_reachable`.
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


@fast_kernel
def reachable_batch(shape: ArmShape, points: FloatArray, axes: FloatArray) -> BoolArray:
    """Return which tool points and approach axes, each of shape (n, 3), are reachable; shape (n,)."""
    arcs = np.empty((MOST_ARCS, 2))
    answers = np.empty(len(points), dtype=np.bool_)
    for i in range(len(points)):
        aim = aim_at(shape, points[i, 0], points[i, 1], points[i, 2], axes[i, 0], axes[i, 1], axes[i, 2])
        answers[i] = is_reachable(shape, aim, arcs)
    return answers


JOINT_NAMES = ("shoulder pan", "shoulder lift", "upper arm roll", "elbow", "wrist")
"""Names for people of the joints that have limits."""

ARC_SAMPLES = 64
"""Samples along an arc, both branches together."""

ELBOW = 3


@kernel
def joint_slacks(shape: ArmShape, aim: ToolPose, pan: float, branch: float) -> tuple[float, float, float, float, float]:
    """Return the slack of each of `JOINT_NAMES` at a pan, with cos(roll) of the sign of `branch`.

    A slack is the sine of the angle by which the joint lies within its limits. Where rounding has left no solution for
    elbow or roll the nearest is taken.
    """
    cos_pan, sin_pan = math.cos(pan), math.sin(pan)
    u, v, w = cos_pan * aim.x + sin_pan * aim.y - shape.offset, cos_pan * aim.y - sin_pan * aim.x, aim.z
    ahead, left = cos_pan * aim.ax + sin_pan * aim.ay, cos_pan * aim.ay - sin_pan * aim.ax
    bones_2 = shape.upper * shape.upper + shape.fore * shape.fore
    cos_elbow = (u * u + v * v + w * w - bones_2) / (2.0 * shape.upper * shape.fore)
    cos_elbow = min(max(cos_elbow, -1.0), 1.0)
    sin_elbow = -math.sqrt(1.0 - cos_elbow * cos_elbow)
    sin_roll = 0.0 if sin_elbow == 0.0 else min(max(v / (shape.fore * sin_elbow), -1.0), 1.0)
    cos_roll = math.copysign(math.sqrt(1.0 - sin_roll * sin_roll), branch)
    a, b = shape.upper + shape.fore * cos_elbow, -shape.fore * cos_roll * sin_elbow
    lift = math.atan2(b, a) - math.atan2(w, u)
    cos_lift, sin_lift = math.cos(lift), math.sin(lift)
    along = (u - shape.upper * cos_lift) * ahead + v * left + (w + shape.upper * sin_lift) * aim.az
    cos_wrist = min(max(along / shape.fore, -1.0), 1.0)
    return (
        slack_within(shape.pan, cos_pan, sin_pan),
        slack_within(shape.lift, cos_lift, sin_lift),
        slack_within(shape.roll, cos_roll, sin_roll),
        slack_within(shape.elbow, cos_elbow, sin_elbow),
        slack_within(shape.wrist, cos_wrist, -math.sqrt(1.0 - cos_wrist * cos_wrist)),
    )


@kernel
def _least_slack(shape: ArmShape, aim: ToolPose, arc: FloatArray, theta: float) -> float:
    """Return the least slack at an angle of the closed curve over an arc."""
    return min(joint_slacks(shape, aim, pan_on(arc, theta), math.copysign(1.0, math.sin(theta))))


@kernel
def _best_try(shape: ArmShape, aim: ToolPose, arcs: FloatArray, count: int) -> tuple[int, float]:
    """Return the arc, among the first `count`, and the angle of its curve at which the least slack is greatest."""
    step = math.tau / ARC_SAMPLES
    best, best_arc, best_theta = -math.inf, 0, 0.0
    for arc in range(count):
        for sample in range(ARC_SAMPLES):
            theta = (sample + 0.5) * step
            least = _least_slack(shape, aim, arcs[arc], theta)
            if least > best:
                best, best_arc, best_theta = least, arc, theta
    while step > FINEST:
        step *= 0.5
        for theta in (best_theta - step, best_theta + step):
            least = _least_slack(shape, aim, arcs[best_arc], theta)
            if least > best:
                best, best_theta = least, theta
    return best_arc, best_theta


@kernel
def _limiting(shape: ArmShape, unpanned: ArmShape, point: FloatArray, axis: FloatArray) -> int:
    """Return the index in `JOINT_NAMES` of the limiting joint; -1 beyond the arm's length.

    `unpanned` is the arm without limits to its pan.
    """
    aim = aim_at(shape, point[0], point[1], point[2], axis[0], axis[1], axis[2])
    if not is_within_length(shape, aim):
        return -1
    arcs = np.empty((MOST_ARCS, 2))
    count = pan_arcs(unpanned, aim, arcs)
    if count == 0:
        return ELBOW
    arc, theta = _best_try(shape, aim, arcs, count)
    slacks = joint_slacks(shape, aim, pan_on(arcs[arc], theta), math.copysign(1.0, math.sin(theta)))
    limiting = 0
    for joint in range(len(slacks)):
        if slacks[joint] < slacks[limiting]:
            limiting = joint
    return limiting


def limiting_joint(shape: ArmShape, point: FloatArray, axis: FloatArray) -> str | None:
    """Return the joint that most keeps the tool from a point along an axis; None beyond the arm's length.

    It is the elbow where no pan at all lets the elbow bend as required, and the joint nearest to a limit where the pose
    is reachable.

    Args:
        shape: the arm.
        point: the tool's position in the shoulder's frame (m), shape (3,).
        axis: the approach axis, shape (3,).
    """
    limiting = _limiting(shape, shape._replace(pan=sector(-math.pi, math.pi)), point, axis)
    return None if limiting < 0 else JOINT_NAMES[limiting]
