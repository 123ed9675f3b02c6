"""The seven joints for a full pose of the tool, near to given joints.

With pan and branch of the elbow fixed, the other six joints follow in closed form. Along the closed curves of the arcs
of pans (see `planner.robots.pr2.kernel`) the search starts at the pan nearest to the given one and ends where the
distance to the given joints has a minimum. Wrist and forearm roll are continuous joints: they are unwound to the turn
nearest to their given angles, so that joints may be interpolated.

As in the kernel the arm is a left arm and poses are in its shoulder's frame (m, rad).
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import ANGLE_RAD
from planner.kernels import kernel
from planner.robots.pr2.aim import ToolPose, aim_at
from planner.robots.pr2.arm import ArmShape, Sector
from planner.robots.pr2.forward_kinematics import BASE_FRAME, Vector, about_x, about_y, about_z
from planner.robots.pr2.pan_arcs import MOST_ARCS, pan_arcs, pan_on

NEARBY, SETTLED, PROBE = 0.2, 1e-4, 1e-5
"""Limits along the curve for neighbouring poses of a path (rad).

The largest distance between them, the precision to which they are refined, and the step that probes the direction.
"""


@kernel
def _within(limits: Sector, angle: float) -> float:
    """Return the equivalent of an angle within limits, or nan; an angle outside by rounding is clipped."""
    angle += math.tau * math.ceil((limits.low - ANGLE_RAD - angle) / math.tau)
    return min(max(angle, limits.low), limits.high) if angle <= limits.high + ANGLE_RAD else math.nan


@kernel
def _unwound(angle: float, near: float) -> float:
    """Return the equivalent of an angle within half a turn of another."""
    return angle - math.tau * math.floor((angle - near) / math.tau + 0.5)


@kernel
def place_wrist(shape: ArmShape, aim: ToolPose, pan: float, branch: float, joints: FloatArray) -> None:
    """Set pan, lift, roll and elbow so that the wrist's centre is at the tool pose's; nan where it cannot be."""
    pan = _within(shape.pan, pan)
    cos_pan, sin_pan = math.cos(pan), math.sin(pan)
    u, v, w = cos_pan * aim.x + sin_pan * aim.y - shape.offset, cos_pan * aim.y - sin_pan * aim.x, aim.z
    bones_2 = shape.upper * shape.upper + shape.fore * shape.fore
    cos_elbow = (u * u + v * v + w * w - bones_2) / (2.0 * shape.upper * shape.fore)
    bent = math.sqrt(max(1.0 - cos_elbow * cos_elbow, 0.0))
    side = shape.fore * bent
    sin_roll, rest = -v, math.sqrt(max(side * side - v * v, 0.0))
    a, b = shape.upper + shape.fore * cos_elbow, branch * rest
    joints[0] = pan
    joints[1] = _within(shape.lift, math.atan2(b, a) - math.atan2(w, u))
    joints[2] = _within(shape.roll, math.atan2(sin_roll, b))
    joints[3] = _within(shape.elbow, -math.atan2(bent, cos_elbow))


@kernel
def _along(axis: Vector, aim: ToolPose) -> float:
    """Return the component of the approach axis along an axis."""
    component: float = aim.ax * axis[0] + aim.ay * axis[1] + aim.az * axis[2]
    return component


@kernel
def turn_hand(shape: ArmShape, aim: ToolPose, rotation: FloatArray, near: FloatArray, joints: FloatArray) -> None:
    """Set the last three joints so that the tool has a rotation."""
    frame = about_x(about_y(about_z(BASE_FRAME, joints[0]), joints[1]), joints[2])
    frame = about_y(frame, joints[3])
    ahead, left, up = _along(frame[0], aim), _along(frame[1], aim), _along(frame[2], aim)
    sideways = math.hypot(left, up)
    joints[4] = near[4] if sideways <= ANGLE_RAD else _unwound(math.atan2(-left, up), near[4])
    joints[5] = _within(shape.wrist, -math.atan2(sideways, ahead))
    _, y, z = about_y(about_x(frame, joints[4]), joints[5])
    cos = y[0] * rotation[0, 1] + y[1] * rotation[1, 1] + y[2] * rotation[2, 1]
    sin = z[0] * rotation[0, 1] + z[1] * rotation[1, 1] + z[2] * rotation[2, 1]
    joints[6] = _unwound(math.atan2(sin, cos), near[6])


@kernel
def _solve_on(
    shape: ArmShape,
    aim: ToolPose,
    rotation: FloatArray,
    near: FloatArray,
    arc: FloatArray,
    theta: float,
    joints: FloatArray,
) -> float:
    """Set the joints at a point of an arc's curve; return the squared distance from `near`, or infinity."""
    place_wrist(shape, aim, pan_on(arc, theta), math.copysign(1.0, math.sin(theta)), joints)
    turn_hand(shape, aim, rotation, near, joints)
    distance = 0.0
    for i in range(7):
        distance += (joints[i] - near[i]) * (joints[i] - near[i])
    return math.inf if math.isnan(distance) else distance


@kernel
def _theta_of(arc: FloatArray, pan: float) -> float:
    """Return the angle of an arc's curve, on the first branch, where the pan is nearest to a given pan."""
    return math.acos(min(max((arc[0] - pan) / max(arc[1], ANGLE_RAD), -1.0), 1.0))


@kernel
def nearby_joints(
    shape: ArmShape, position: FloatArray, rotation: FloatArray, near: FloatArray
) -> tuple[bool, FloatArray]:
    """Return whether joints near to those of a neighbouring pose bring the tool to a pose, and these, shape (7,).

    Gauss-Newton steps lead along one curve: to a local minimum of the distance to `near`.
    """
    aim = aim_at(shape, position[0], position[1], position[2], rotation[0, 0], rotation[1, 0], rotation[2, 0])
    arcs, joints = np.empty((MOST_ARCS, 2)), np.empty(7)
    best, best_arc, best_theta = math.inf, -1, 0.0
    for arc in range(pan_arcs(shape, aim, arcs)):
        present = _theta_of(arcs[arc], near[0])
        for theta in (present, -present):
            distance = _solve_on(shape, aim, rotation, near, arcs[arc], theta, joints)
            if distance < best:
                best, best_arc, best_theta = distance, arc, theta
    if best_arc < 0:
        return False, joints
    ahead = np.empty(7)
    _solve_on(shape, aim, rotation, near, arcs[best_arc], best_theta, joints)
    while True:
        step = _step_towards(shape, aim, rotation, near, arcs[best_arc], best_theta, joints, ahead)
        is_nearer = False
        while abs(step) > SETTLED and not is_nearer:
            distance = _solve_on(shape, aim, rotation, near, arcs[best_arc], best_theta + step, ahead)
            is_nearer = distance < best
            if is_nearer:
                best, best_theta = distance, best_theta + step
                joints[:] = ahead
            step *= 0.5
        if not is_nearer:
            return True, joints


@kernel
def _step_towards(
    shape: ArmShape,
    aim: ToolPose,
    rotation: FloatArray,
    near: FloatArray,
    arc: FloatArray,
    theta: float,
    joints: FloatArray,
    ahead: FloatArray,
) -> float:
    """Return how far along an arc's curve the linearised joints are nearest to `near` (rad).

    `ahead` is scratch space, shape (7,).
    """
    probe = PROBE
    if _solve_on(shape, aim, rotation, joints, arc, theta + probe, ahead) == math.inf:
        probe = -PROBE
        if _solve_on(shape, aim, rotation, joints, arc, theta + probe, ahead) == math.inf:
            return 0.0
    along, squared = 0.0, 0.0
    for i in range(7):
        rate = (ahead[i] - joints[i]) / probe
        along += rate * (near[i] - joints[i])
        squared += rate * rate
    if squared == 0.0:
        return 0.0
    return min(max(along / squared, -NEARBY), NEARBY)
