"""The reach of a robot whose arms have reach maps, with the shortfall of places out of reach."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias, cast

import numpy as np

from planner.deadline import Deadline
from planner.geometry.driving import STANDOFF_STEP_M
from planner.geometry.pose import FloatArray, point3
from planner.geometry.reach_query import ReachQuery, Shortfall
from planner.robots.arm_query import ArmNumbers
from planner.robots.comfort_reach import ComfortReach, Memories, QueriedArms
from planner.robots.displacements import DIRECTIONS, FURTHEST_M, cause_of, homewards
from planner.robots.mapped_comfort import MappedArms, joint_at_limit, nearest_place, widest_circle

Heights: TypeAlias = tuple[tuple[float, float], ...]
"""The lowest and the highest point of each arm's map, seen from its root (m)."""

Covering: TypeAlias = Callable[[int, FloatArray], tuple[MappedArms, Heights]]
"""Has an arm's map cover points that are seen from its root; returns all arms with their maps, and these' heights."""

_QUERIES_MAX = 50_000
"""Queries after which a shortfall is returned as far as it is known: some tenths of a second."""

_QUERIES_LATE_MAX = 5_000
"""The same where nobody waits for the answer any more."""


class MappedReach(ComfortReach):
    """The reach of a robot whose arms have reach maps; see `ComfortReach`."""

    def __init__(
        self,
        queried: QueriedArms,
        heights: Heights,
        covering: Covering,
        joint_names: tuple[tuple[str, ...], ...],
        lengths_m: tuple[float, ...],
        torso_m: float,
        comfort_m: float,
        memories: Memories | None = None,
    ) -> None:
        """Start with nothing remembered.

        Args:
            queried: the arms, with maps.
            heights: those that their maps cover.
            covering: has an arm's map cover more.
            joint_names: the joints of each arm.
            lengths_m: how far from its root each arm may reach (m).
            torso_m: how far the lift is raised (m).
            comfort_m: the comfort radius (m).
            memories: what earlier plans have learned; None: nothing.
        """
        super().__init__(queried, torso_m, comfort_m, memories)
        self._heights = heights
        self._covering = covering
        self._joint_names = joint_names
        self._lengths_m = lengths_m

    def _arms(self) -> MappedArms:
        """Return the arms with their maps."""
        return cast(MappedArms, self._queried.numbers)

    def _numbers_for(self, query: ReachQuery) -> ArmNumbers:
        """Return the arms with maps that cover some points."""
        seen = query.points - self._shoulders[query.arm]
        low_m, high_m = self._heights[query.arm]
        if seen.size and (seen[..., 2].min() < low_m or seen[..., 2].max() > high_m):
            numbers, self._heights = self._covering(query.arm, seen)
            self._queried = replace(self._queried, numbers=numbers)
        return self._queried.numbers

    def _searched_m(self, arm: int, seen: FloatArray, furthest_m: float) -> float:
        """Return how far points were displaced in every direction in which the arm's map or its length ends (m)."""
        searched_m = furthest_m
        for x, y, z in seen:
            for end_m in self._heights[arm]:
                if math.hypot(x, y, end_m) < self._lengths_m[arm]:
                    searched_m = min(searched_m, abs(end_m - z))
        return searched_m

    def at_least_short(self, ways: ReachQuery) -> FloatArray:
        """Return how far each way's points are beyond the arm's length from the best standoff (see `Reach`)."""
        ahead = np.arange(ways.count)[:, None] * np.array([STANDOFF_STEP_M, 0.0, 0.0])
        seen = (ways.points - self._shoulders[ways.arm])[:, :, None] + ahead
        away = np.linalg.norm(seen, axis=-1) - self._lengths_m[ways.arm] + self.comfort_m
        return np.asarray(np.maximum(away.min(axis=2).max(axis=1), 0.0))

    def _least_shortfall(self, place: ReachQuery, at_most_m: float, deadline: Deadline) -> tuple[Shortfall, int]:
        arm, approaches = place.arm, place.approaches
        seen, labels = place.points - self._shoulders[arm], self._queried.labels[arm][approaches]
        furthest = min(at_most_m, FURTHEST_M)
        most = _QUERIES_LATE_MAX if deadline.is_long_over else _QUERIES_MAX
        short_by_m, seen_from, approach, direction, queries = nearest_place(
            self._arms(), labels, seen, DIRECTIONS, self.comfort_m, furthest, most
        )
        is_at_least = seen_from < 0
        if is_at_least:
            distances = np.linalg.norm(seen, axis=1)
            seen_from, approach = int(distances.argmin()), 0
            searched = self._searched_m(arm, seen, furthest) if queries < most else 0.0
            short_by_m = max(float(distances.min()) - self._lengths_m[arm], searched)
        point = seen[seen_from]
        towards = homewards(point) if is_at_least else DIRECTIONS[direction]
        cause, comfort_m = "too_far" if is_at_least else cause_of(point, towards, short_by_m), None
        widest_m, widest_from, _ = widest_circle(self._arms(), labels, seen, self.comfort_m)
        if widest_from >= 0:
            cause, comfort_m = "comfort_only", widest_m
        joint = joint_at_limit(self._arms(), int(labels[approach]), point)
        name = None if joint < 0 else self._joint_names[arm][joint]
        chosen = int(approaches[approach])
        found = Shortfall(cause, name, short_by_m, is_at_least, point3(towards), chosen, seen_from, comfort_m)
        return found, queries

    def _shortfall_together(self, places: ReachQuery, at_most_m: float, deadline: Deadline) -> Shortfall | None:
        each = [self.from_anywhere(replace(places, points=points, count=1)) for points in places.points]
        had = np.stack([one.any(axis=1) for one in each], axis=1)
        if had.all(axis=1).any():
            return None
        best: Shortfall | None = None
        for row in np.argsort(-had.sum(axis=1), kind="stable"):
            if best is not None and deadline.is_long_over:
                break
            limit_m = at_most_m if best is None else min(at_most_m, best.short_by_m)
            worst: Shortfall | None = None
            for number in np.flatnonzero(~had[row]).tolist():
                found = self._shortfall_of(places, number, places.approaches[row : row + 1], limit_m, deadline)
                if found is not None and (worst is None or found.short_by_m > worst.short_by_m):
                    worst = found
                if worst is not None and worst.short_by_m >= limit_m:
                    break
            if worst is not None and (best is None or worst.short_by_m < best.short_by_m):
                best = worst
        return best
