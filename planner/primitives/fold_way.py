"""A way for one robot to perform a fold from one station: which hands take which grips, and with which approaches."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import FloatArray
from planner.geometry.reach_query import ReachQuery
from planner.primitives.context import Context
from planner.primitives.fold_trial import FoldTrial
from planner.primitives.obstacle import Attempt
from planner.primitives.state import State

AHEAD_M = 0.7
"""The typical distance of a working hand ahead of its shoulder on a table (m)."""


@dataclass(frozen=True, eq=False, slots=True)
class FoldWay:
    """A choice of grips, arms and approaches with which the robot can follow a fold from one station.

    Attributes:
        trial: the grips, the arms, the path.
        approaches: each grip's approach.
    """

    trial: FoldTrial
    approaches: tuple[int, ...]

    def is_like(self, other: "FoldWay") -> bool:
        """Return whether the same arms take the same grips in the same approaches."""
        return self.trial.is_like(other.trial) and self.approaches == other.approaches

    def strip(self, context: Context, station: int) -> NDArray[np.uint32]:
        """Return the standoffs that keep every hand within the comfort radius, as bit masks, shape (waypoints,)."""
        hands = zip(self.trial.arms, self.trial.in_base(context, station), self.approaches, strict=True)
        masks = [
            context.reach.standoffs(ReachQuery(arm, points, np.array([approach]), context.standoffs))[0]
            for arm, points, approach in hands
        ]
        return np.asarray(np.bitwise_and.reduce(masks))


def can_follow(context: Context, station: int, trial: FoldTrial, stands: int | None = None) -> bool:
    """Return whether the arms can follow a trial, with the base free to drive.

    Args:
        context: the planning context.
        station: where the robot stands.
        trial: grips, arms and path.
        stands: the standoffs at one of which the path is begun, as a bit mask; None: any.
    """
    begun = np.zeros(context.standoffs, dtype=np.int64)
    if stands is not None:
        begun[[not stands >> standoff & 1 for standoff in range(context.standoffs)]] = IMPOSSIBLE
    return bool(trial.following(context, station)(begun, wanted="any").ends)


def attempt_of(state: State, trial: FoldTrial, places: FloatArray) -> Attempt:
    """Return the record of a trial that failed at each of some offsets of the garment, shape (n, 2), m."""
    return Attempt(trial.fold, state, trial.cover, trial.arms, trial.path, trial.points, trial.approaches, places)


def away_from_shoulders(context: Context, station: int, arms: tuple[int, ...], tools: FloatArray) -> FloatArray:
    """Return how far the hands must go from their shoulders at most (m): sideways, up, down, and too far ahead.

    The base can back off but not come closer, so a point ahead counts only as far as it lies beyond `AHEAD_M`. The
    number serves only to compare attempts that were out of reach.

    Args:
        context: the planning context.
        station: where the robot stands.
        arms: the arm of each grip.
        tools: each grip's tool points in the table frame, shape (grips, n, ..., 3), m.

    Returns:
        The largest distance over grips and points, shape (...).
    """
    found = []
    for arm, points in zip(arms, tools, strict=True):
        away = context.in_base(station, points) - np.array(context.reach.shoulders[arm])
        away[..., 0] = np.maximum(away[..., 0] - AHEAD_M, 0.0)
        found.append(np.sqrt((away**2).sum(axis=-1)).max(axis=0))
    return np.asarray(np.max(found, axis=0))
