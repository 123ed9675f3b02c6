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

Lengths are in m, angles in rad, and everything is in the shoulder's frame: parallel to the base, its origin on the pan
axis at the height of the lift axis. The arm is a left arm (see `planner.robots.pr2.arm`).

Numbers in other files are part of the compiled code, so the arm's are arguments (for the cache of compiled code see
`planner.kernel_cache`).
"""

import math

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import fast_kernel, kernel
from planner.robots.pr2.aim import ToolPose, aim_at
from planner.robots.pr2.arm import ArmShape, Sector
from planner.robots.pr2.joint_slack import slacks
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
