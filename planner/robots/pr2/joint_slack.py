"""The slack at one pan: the distance of the joints from their limits, maximised in closed form.

A slack is the sine of an angle, so that it needs no arc functions: negative outside of the limits, and as smooth as the
angle itself near them. The formulas are those of `planner.robots.pr2.kernel`.
"""

import math

from planner.kernels import fast_kernel
from planner.robots.pr2.aim import ToolPose
from planner.robots.pr2.arm import ArmShape, Sector


@fast_kernel
def slack_within(limits: Sector, cos: float, sin: float) -> float:
    """Return the sine of the angle by which a direction lies within limits; negative outside of them."""
    above = sin * limits.cos_low - cos * limits.sin_low
    below = cos * limits.sin_high - sin * limits.cos_high
    return min(above, below) if limits.high - limits.low <= math.pi else max(above, below)


@fast_kernel
def slacks(shape: ArmShape, aim: ToolPose, pan: float) -> tuple[float, float]:
    """Return the least slack of lift, roll, elbow and wrist at a pan, for cos(roll) >= 0 and for cos(roll) <= 0."""
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


@fast_kernel
def _lift_and_wrist_slack(
    shape: ArmShape, wrist: tuple[float, float, float], axis: tuple[float, float, float], a: float, b: float
) -> float:
    """Return the lesser slack of lift and wrist for a wrist's centre and an axis seen from the panned shoulder."""
    u, v, w = wrist
    length_2 = a * a + b * b
    cos_lift, sin_lift = (a * u + b * w) / length_2, (b * u - a * w) / length_2
    along = (u - shape.upper * cos_lift) * axis[0] + v * axis[1] + (w + shape.upper * sin_lift) * axis[2]
    cos_wrist = min(max(along / shape.fore, -1.0), 1.0)
    sin_wrist = -math.sqrt(1.0 - cos_wrist * cos_wrist)
    lift = slack_within(shape.lift, cos_lift, sin_lift)
    return min(lift, slack_within(shape.wrist, cos_wrist, sin_wrist))


@fast_kernel
def ring_slack(shape: ArmShape, aim: ToolPose, radius: float, pan: float, branch: float) -> tuple[float, int]:
    """Return the least slack at one pan and branch (sign of cos(roll)) of a tool pose and four on a circle round it.

    The second value tells which pose has it: 0 is the tool pose itself, the others are numbered as in `beside`.
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
