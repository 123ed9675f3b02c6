"""The joint that keeps the arm from a tool pose.

Where all limits are kept, an unreachable pose has no solution to examine. So the pan's limits are dropped: along the
arcs that are then left (see `planner.robots.pr2.kernel`) every joint but the elbow may be outside its limits, and its
slack says by how much. The arm's best try is the pan at which the least of the five slacks is greatest, and the joint
with that least slack is the limiting one.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.pr2.aim import ToolPose, aim_at, is_within_length
from planner.robots.pr2.arm import ArmShape, sector
from planner.robots.pr2.joint_slack import slack_within
from planner.robots.pr2.kernel import FINEST
from planner.robots.pr2.pan_arcs import MOST_ARCS, pan_arcs, pan_on

JOINT_NAMES = ("shoulder pan", "shoulder lift", "upper arm roll", "elbow", "wrist")
"""Names for people of the joints that have limits."""

SAMPLES = 64
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
    step = math.tau / SAMPLES
    best, best_arc, best_theta = -math.inf, 0, 0.0
    for arc in range(count):
        for sample in range(SAMPLES):
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
