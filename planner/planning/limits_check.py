"""Check that nothing in a plan's motion is faster than its limit, nor speeds up harder."""

import math

import numpy as np

from planner.errors import RequestError
from planner.geometry.keyframes import Values, peaks
from planner.geometry.pose import FloatArray, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.motion.motion_limits import MotionLimits
from planner.motion.path_timing import EXCESS
from planner.planning.problem import Problem
from planner.task.trajectory import Segment, Trajectory

_ROUNDING = 1.001
"""What a speed or an acceleration may be, as a share of the greatest; what exceeds 1 allows for rounding."""


def require_limits(problem: Problem, path: Trajectory) -> None:
    """Require that joints, fingers and base keep their speeds, and their accelerations where velocities are given.

    Raises:
        RequestError: names what is too fast or too hard, when, and by how much.
    """
    limits = MotionLimits.of(problem.robot.card, problem.context.scene)
    arms, count = path.arms, len(path.arms.names)
    _require(limits.names, limits.speeds, limits.accelerations, (arms.times_s, arms.rows, arms.rates))
    for number, track in enumerate(path.grippers, count):
        own = slice(number, number + 1)
        keyframes = (track.times_s, np.array(track.positions)[:, None], np.array(track.velocities)[:, None])
        _require(limits.names[own], limits.speeds[own], limits.accelerations[own], keyframes)
    for segment in path.segments:
        _require_base(segment, limits)


def _require_base(segment: Segment, limits: MotionLimits) -> None:
    start, end = segment.phase.base
    driven_m = math.dist((start.x_m, start.y_m), (end.x_m, end.y_m))
    turned_rad = abs(wrapped_angle(end.yaw_rad - start.yaw_rad))
    times, done = segment.start_s + np.array(segment.times_s), np.array(segment.fractions)[:, None]
    rates = np.array(segment.base_rates)[:, None]
    ways = (("the base", driven_m, LENGTH_M, -3), ("the base's yaw", turned_rad, ANGLE_RAD, -1))
    for name, way, least, own in ways:
        if way > least:
            keyframes = (times, way * done, way * rates)
            _require((name,), limits.speeds[[own]], limits.accelerations[[own]], keyframes)


def _require(
    names: tuple[str, ...],
    speeds: FloatArray,
    accelerations: FloatArray,
    keyframes: tuple[Values, Values, Values],
) -> None:
    """Require that columns of keyframes keep their limits."""
    times, values, rates = map(np.asarray, keyframes)
    if len(times) < 2:
        return
    count = values.shape[1]
    fastest, hardest = peaks(times, values, rates)
    for found, most, excess, told in (
        (fastest, speeds[:count], 1.0, "moves {:.2f} times as fast"),
        (hardest, accelerations[:count], EXCESS, "speeds up or slows down {:.2f} times as hard"),
    ):
        shares = found / most
        row, column = np.unravel_index(shares.argmax(), shares.shape)
        if shares[row, column] > _ROUNDING * excess:
            what = told.format(shares[row, column])
            raise RequestError("trajectory", f"at {times[row]:.2f} s {names[column]} {what} as its limit allows")
