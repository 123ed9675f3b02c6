"""A plan's motion for controllers: smooth, with the speeds and accelerations of all joints bounded.

A plan's trajectory goes straight from keyframe to keyframe, so its velocities jump. Here a curve with continuous second
derivatives goes through the same keyframes. A step takes as long as in the plan where speeds and accelerations allow:
it is slower where it turns, and a little quicker elsewhere, no more than it must be. All joints, grippers and the base
share one clock, so hands that carry a cloth together stay together. Each step begins and ends at rest and can be sent
alone.

The curve is a cubic spline through fine samples of a monotone one (Fritsch and Carlson): it does not overshoot, as a
spline through the keyframes alone would, and its accelerations do not jump, as the monotone one's do.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.optimize import brentq
from toppra import SplineInterpolator
from toppra.algorithm import TOPPRA
from toppra.constraint import DiscretizationType, JointAccelerationConstraint, JointVelocityConstraint

from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.motion_limits import MotionLimits
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep
from planner.task.trajectory import Trajectory

STRAIGHT_S = 0.1
"""Corners are rounded within this time (s): longer stretches between keyframes are cut, and so stay straight."""

_FINE_S = 0.02
"""The time between the samples through which the spline goes (s)."""

_SAME_S = 1e-6
"""Keyframes of different tracks nearer than this are one (s)."""

PACE_MAX = 2.0
"""The most seconds of the plan in one second of a smooth motion."""

_PACE_FOUND = 0.01
"""The accuracy to which the least pace is found with which a step takes no longer than in the plan."""

_SPARE = 0.03
"""The share of a step's time that is left, when the pace is found, for keeping limits between the solver's points."""

_HURRY_S2 = 10.0
"""Bounds the change of the pace through the plan (1/s2) where nothing moves, so that no joint bounds it."""

_HELD_BACK = 0.99
"""The share of the accelerations that the solver is given: the rest is for what lies between its grid points."""

_ROUNDS = 3
"""Solutions that are tried with limits tightened by what the one before exceeds them between its grid points."""


@dataclass(frozen=True, eq=False)
class SmoothStep:
    """The motion of one step of a plan, at rest at both ends.

    Attributes:
        number: the step's index.
        start_s: when it begins on the clock of the smooth motion, on which no step waits for another (s).
        duration_s: how long it takes (s).
        deviation: the furthest that a joint of an arm is from the plan's straight lines between keyframes, on which it
            is exact (rad; m for prismatic ones).
    """

    number: int
    start_s: float
    duration_s: float
    deviation: float
    _run: Any
    _stretch: float
    _columns: int

    @property
    def end_s(self) -> float:
        """The time of its end on that clock (s)."""
        return self.start_s + self.duration_s

    def at(self, times_s: FloatArray, order: int = 0) -> FloatArray:
        """Return what moves at times since the step's start, or its first or second derivative by time.

        Returns:
            Joints, grippers and base in the order of `MotionLimits.names`, shape (n, names): rad, m; per s, per s2.
        """
        return np.asarray(self._whole(times_s, order)[:, : self._columns])

    def plan_s(self, times_s: FloatArray) -> FloatArray:
        """Return the times of the plan at times since the step's start (s), shape (n,)."""
        return np.asarray(self._whole(times_s, 0)[:, -1])

    def times_s(self, rate_hz: float) -> FloatArray:
        """Return times since the step's start at an even rate, or a little more densely, from 0 to its end (s)."""
        return np.linspace(0.0, self.duration_s, max(math.ceil(self.duration_s * rate_hz - TIME_S), 1) + 1)

    def _whole(self, times_s: FloatArray, order: int) -> FloatArray:
        inner = np.clip(times_s / self._stretch, 0.0, self._run.duration)
        return np.asarray(self._run(inner, order) / self._stretch**order)


def smooth_steps(plan: Plan, limits: MotionLimits) -> Iterator[SmoothStep]:
    """Yield a motion of each step that keeps the limits and takes as long as in the plan, or as little more as can be.

    Raises:
        UnsolvedPlanError: the plan has no trajectory.
    """
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    start_s = 0.0
    for number, step in enumerate(plan.steps):
        smooth = _smooth(number, start_s, step, plan.trajectory, limits)
        yield smooth
        start_s = smooth.end_s


def _smooth(number: int, start_s: float, step: PlanStep, path: Trajectory, limits: MotionLimits) -> SmoothStep:
    knots = _cut(_keyframes(number, step, path), STRAIGHT_S, 1)
    fine = _cut(knots, _FINE_S, 2)
    curve = _monotone(knots, planned_values(path, knots))(fine)
    rest = np.append(np.zeros(len(limits.bounds[0])), 1.0)
    whole = SplineInterpolator(fine, np.column_stack([limits.bounded(curve), fine]), ((1, rest), (1, rest)))
    run, stretch = _in_time(_Path(whole, fine, limits), step.duration_s)
    arms = len(path.arms.names)
    looked = _cut(knots, _FINE_S / 2, 4)
    deviation = np.abs(whole(looked)[:, :arms] - planned_values(path, looked)[:, :arms]).max()
    return SmoothStep(number, start_s, float(run.duration) * stretch, float(deviation), run, stretch, curve.shape[1])


def _keyframes(number: int, step: PlanStep, path: Trajectory) -> FloatArray:
    """Return the times of all keyframes in a step, its ends included, rising (s)."""
    tracks = [path.arms.times_s, *(track.times_s for track in path.grippers)]
    segments = [segment.start_s + np.array(segment.times_s) for segment in path.of_step(number)]
    times = np.unique(np.concatenate([*map(np.array, tracks), *segments]))
    inner = times[(times > step.start_s + _SAME_S) & (times < step.end_s - _SAME_S)]
    times = np.concatenate([[step.start_s], inner, [step.end_s]])
    return np.asarray(times[np.append(True, np.diff(times) > _SAME_S)])


def _cut(times: FloatArray, longest_s: float, least: int) -> FloatArray:
    """Return rising times with each stretch cut evenly into parts no longer than a time, at least into some."""
    counts = [max(least, math.ceil((b - a) / longest_s - _SAME_S)) for a, b in pairwise(times)]
    parts = [np.linspace(a, b, count + 1)[:-1] for (a, b), count in zip(pairwise(times), counts, strict=True)]
    return np.append(np.concatenate(parts), times[-1])


def planned_values(path: Trajectory, times_s: FloatArray) -> FloatArray:
    """Return joints, grippers and base at times of the plan, shape (n, names)."""
    arms = np.array([path.arms.at(t) for t in times_s.tolist()])
    fingers = np.array([[track.position_at(t) for track in path.grippers] for t in times_s.tolist()])
    poses = [path.segment_at(t).base_at(t) for t in times_s.tolist()]
    bases = np.array([(pose.x_m, pose.y_m, pose.yaw_rad) for pose in poses])
    return np.column_stack([arms, fingers, bases[:, :2], np.unwrap(bases[:, 2])])


def _monotone(times_s: FloatArray, values: FloatArray) -> CubicHermiteSpline:
    """Return the monotone curve through values, at rest at both ends."""
    slopes = PchipInterpolator(times_s, values)(times_s, 1)
    slopes[[0, -1]] = 0.0
    return CubicHermiteSpline(times_s, values, slopes)


@dataclass(frozen=True, eq=False)
class _Path:
    """A path with the limits of what moves along it; its last coordinate is the plan's time (s).

    Attributes:
        curve: the path.
        fine: its samples (s).
        limits: of what moves; the other coordinates are what they bound.
    """

    curve: SplineInterpolator
    fine: FloatArray
    limits: MotionLimits

    def quickest(self, pace: float) -> tuple[Any, float]:
        """Return the quickest run at a pace, and how far it must be stretched to keep the limits everywhere.

        The solver keeps them at its grid points alone, so it is given tighter ones where it exceeds them in between.
        """
        accelerations = _HELD_BACK * self.limits.bounds[1]
        runs = []
        for _ in range(_ROUNDS):
            run = self.run(pace, accelerations)
            times = np.linspace(0.0, run.duration, 12 * len(self.fine))
            excess = self.limits.excess(run(times, 1)[:, :-1], run(times, 2)[:, :-1])
            runs.append((run.duration * excess, excess, run))
            accelerations = accelerations / excess**2
        _, stretch, quickest = min(runs, key=lambda tried: tried[0])
        return quickest, stretch

    def run(self, pace: float, accelerations: FloatArray) -> Any:  # noqa: ANN401
        """Return the quickest run with some accelerations, and with at most a pace through the plan's time."""
        speeds, hard = np.append(self.limits.bounds[0], pace), np.append(accelerations, _HURRY_S2)
        bounds = [
            JointVelocityConstraint(np.column_stack([-speeds, speeds])),
            JointAccelerationConstraint(np.column_stack([-hard, hard]), DiscretizationType.Interpolation),
        ]
        grid = np.sort(np.concatenate([self.fine, 0.5 * (self.fine[:-1] + self.fine[1:])]))
        solver = TOPPRA(bounds, self.curve, gridpoints=grid, parametrizer="ParametrizeConstAccel")
        return solver.compute_trajectory(0.0, 0.0)


def _in_time(path: _Path, planned_s: float) -> tuple[Any, float]:
    """Return the run with the least hurry that takes as long as planned, or the quickest; and its stretch."""

    def late_s(pace: float) -> float:
        return float(path.run(pace, _HELD_BACK * path.limits.bounds[1]).duration) - (1.0 - _SPARE) * planned_s

    pace = PACE_MAX
    if late_s(PACE_MAX) < 0.0:
        pace = min(brentq(late_s, 1.0, PACE_MAX, xtol=_PACE_FOUND) + _PACE_FOUND, PACE_MAX)
    run, stretch = path.quickest(pace)
    return run, max(stretch, planned_s / float(run.duration))
