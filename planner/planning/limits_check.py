"""Check that a plan's joints stay within their limits, and nothing is faster than its limit or speeds up harder."""

import math
from collections.abc import Iterator, Sequence
from typing import TypeAlias

import numpy as np

from planner.errors import RequestError
from planner.geometry.keyframes import extremes, peaks
from planner.geometry.pose import FloatArray, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.motion.motion_values import MotionLimits
from planner.motion.path_timing import EXCESS
from planner.planning.problem import Problem
from planner.task.trajectory import Trajectory

Keyframes: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]
"""Times (s), shape (n,), with values and their rates (1/s), shape (n, k); rates may be empty."""

_ROUNDING = 1.001
"""The largest speed or acceleration accepted, as a share of its limit; the excess over 1 allows for rounding."""


def require_limits(problem: Problem, path: Trajectory) -> None:
    """Require that joints stay within their soft limits, and that joints, fingers and base keep their speeds.

    They keep their accelerations too, where velocities are given.

    Raises:
        RequestError: names the step, as ``steps[2].trajectory``, and says what is out of its limits, too fast or too
            hard, when, and by how much.
    """
    limits = MotionLimits.of(problem.robot.card, problem.context.scene)
    low_m, high_m = problem.robot.card.lift_limits_m
    if not low_m - LENGTH_M <= path.torso_m <= high_m + LENGTH_M:
        said = f"the lift is at {path.torso_m:g} m, it goes from {low_m:g} to {high_m:g} m"
        raise RequestError("trajectory.torso_m", said)
    _require_ranges(limits, path)
    for names, own, keyframes in _tracks(path, limits):
        found = _excess(names, limits.speeds[own], limits.accelerations[own], keyframes)
        if found is not None:
            t_s, what = found
            field = f"steps[{path.segment_at(t_s).step}].trajectory"
            raise RequestError(field, f"at {t_s:.2f} s {what} as its limit allows")


def _require_ranges(limits: MotionLimits, path: Trajectory) -> None:
    """Require that arms' joints stay within their limits, also between keyframes."""
    arms, (low, high) = path.arms, limits.ranges.T
    times_s, rows = np.array(arms.times_s), arms.rows
    ends = extremes(times_s, rows, arms.rates) if len(rows) > 1 else (rows, rows)
    beyond = np.maximum(low - ends[0], ends[1] - high)
    row, column = np.unravel_index(beyond.argmax(), beyond.shape)
    if beyond[row, column] > ANGLE_RAD:
        t_s, name = float(times_s[row]), arms.names[column]
        said = f"{name} is {beyond[row, column]:.3f} rad beyond its limits {low[column]:g} and {high[column]:g}"
        raise RequestError(f"steps[{path.segment_at(t_s).step}].trajectory", f"at {t_s:.2f} s {said}")


def _tracks(path: Trajectory, limits: MotionLimits) -> Iterator[tuple[tuple[str, ...], slice, Keyframes]]:
    """Yield columns of keyframes, with their names and their part of the limits."""
    arms, count = path.arms, len(path.arms.names)
    yield arms.names, slice(count), (np.array(arms.times_s), arms.rows, arms.rates)
    for number, track in enumerate(path.grippers, count):
        keyframes = (np.array(track.times_s), _column(track.positions), _column(track.velocities))
        yield (track.joint,), slice(number, number + 1), keyframes
    yaw = len(limits.names) - 1
    for segment in path.segments:
        start, end = segment.phase.base
        driven_m = math.dist((start.x_m, start.y_m), (end.x_m, end.y_m))
        turned_rad = abs(wrapped_angle(end.yaw_rad - start.yaw_rad))
        times_s = segment.start_s + np.array(segment.times_s)
        done, rates = _column(segment.fractions), _column(segment.base_rates)
        if driven_m > LENGTH_M:
            yield ("the base",), slice(yaw - 1, yaw), (times_s, driven_m * done, driven_m * rates)
        if turned_rad > ANGLE_RAD:
            yield ("the base's turn",), slice(yaw, yaw + 1), (times_s, turned_rad * done, turned_rad * rates)


def _column(values: Sequence[float]) -> FloatArray:
    return np.array(values).reshape(-1, 1)


def _excess(
    names: tuple[str, ...], speeds: FloatArray, accelerations: FloatArray, keyframes: Keyframes
) -> tuple[float, str] | None:
    """Return when a value exceeds its limits most and what it does; None if none does."""
    times_s, values, rates = keyframes
    if len(times_s) < 2:
        return None
    fastest, hardest = peaks(times_s, values, rates)
    for shares, most, what in (
        (fastest / speeds, _ROUNDING, "moves {:.2f} times as fast"),
        (hardest / accelerations, _ROUNDING * EXCESS, "speeds up or slows down {:.2f} times as hard"),
    ):
        row, column = np.unravel_index(shares.argmax(), shares.shape)
        if shares[row, column] > most:
            return float(times_s[row]), f"{names[column]} {what.format(shares[row, column])}"
    return None
