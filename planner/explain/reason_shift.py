"""Find how far a hand's whole path must be shifted to be in reach.

The point that is furthest out of reach says why an attempt failed. But repairing that point alone may not be enough,
since the hands must follow their whole path. A sure repair is to shift the whole path as the robot sees it, which a
person can do: sideways by moving the station or the cloth, up or down by the height of the table or the torso. The
least such shift is looked for along each of `DIRECTIONS`, and each shift is tried as the planner would try it.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from planner.explain.reason_miss import Miss
from planner.geometry.pose import FloatArray, Point3
from planner.primitives.context import STANDOFF_STEP_M, Context
from planner.primitives.fold_way import can_follow

FURTHEST_M = 0.2
"""Largest shift that is tried (m)."""

_STEP_M, _FINEST_M = 0.02, 0.001
"""Step between the shifts tried, and how exactly the least shift is found (m)."""

_SLANT = math.sqrt(0.5)

DIRECTIONS: tuple[Point3, ...] = (
    (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    (0.0, -1.0, 0.0),
    (1.0, 0.0, 0.0),
    (-_SLANT, _SLANT, 0.0),
    (-_SLANT, -_SLANT, 0.0),
    (_SLANT, _SLANT, 0.0),
    (_SLANT, -_SLANT, 0.0),
    (0.0, 0.0, -1.0),
    (0.0, 0.0, 1.0),
)
"""Directions in which a path is shifted, base frame: eight horizontal directions, down and up."""


@dataclass(frozen=True, slots=True)
class ReachShift:
    """A shift that brings a whole attempt into reach.

    Attributes:
        distance_m: the distance (m).
        towards: the unit direction, base frame.
    """

    distance_m: float
    towards: Point3


def least_shift(context: Context, miss: Miss) -> ReachShift | None:
    """Return the least shift tried that lets the arms follow an attempt; None if none does."""
    attempt = _Shifted(context, miss)
    best: ReachShift | None = None
    for towards in DIRECTIONS:
        limit = FURTHEST_M if best is None else best.distance_m - _FINEST_M
        distance = attempt.least(towards, limit)
        if distance is not None:
            best = ReachShift(distance, towards)
    return best


class _Shifted:
    """An attempt, shifted as its robot sees it."""

    def __init__(self, context: Context, miss: Miss) -> None:
        self._context = context
        self._trial = miss.trial
        self._station = miss.state.station
        self._stands = miss.stands
        pose = context.station_pose(self._station)
        self._axes = pose.to_outer(np.eye(3)) - pose.to_outer(np.zeros((3, 3)))
        last = len(miss.trial.sweeps) - 1
        self._extremes = (last // 2, last, 0)

    def least(self, towards: Point3, limit: float) -> float | None:
        """Return the least sufficient shift along a direction, up to a limit; None if there is none."""
        outer = np.array(towards) @ self._axes
        near, far, deadline = 0.0, _STEP_M, self._context.deadline
        while far <= limit + _FINEST_M and not deadline.is_over:
            short = self._at_least_short(far * outer)
            if short > 0.0:
                near, far = far + short, far + max(_STEP_M, _STEP_M * math.ceil(short / _STEP_M))
            elif self._is_in_reach(far * outer):
                return self._settled(outer, near, far)
            else:
                near, far = far, far + _STEP_M
        return None

    def _settled(self, outer: FloatArray, near: float, far: float) -> float:
        while far - near > _FINEST_M:
            middle = 0.5 * (near + far)
            near, far = (near, middle) if self._is_in_reach(middle * outer) else (middle, far)
        return far

    def _at_least_short(self, shift: FloatArray) -> float:
        context, trial = self._context, self._trial
        return max(
            float(
                context.reach.at_least_short(
                    arm, self._seen(hand, shift)[None], approaches, context.standoffs, STANDOFF_STEP_M
                )[0]
            )
            for hand, (arm, approaches) in enumerate(zip(trial.arms, trial.approaches, strict=True))
        )

    def _is_in_reach(self, shift: FloatArray) -> bool:
        """Return whether the arms can follow the attempt, shifted in the table frame."""
        shifted = replace(self._trial, tools=self._trial.tools + shift)
        return can_follow(self._context, self._station, shifted, self._stands)

    def _seen(self, hand: int, shift: FloatArray) -> FloatArray:
        """Return apex, end and start of a hand's path in the base frame, shape (3, 3), m."""
        return self._context.in_base(self._station, self._trial.tools[hand, list(self._extremes)] + shift)
