"""A stand-in for a robot's reach: arms that reach everything, or what lies in bands ahead of the base."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.driving import IMPOSSIBLE, STANDOFF_STEP_M, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.reach_query import ReachQuery, Shortfall
from planner.primitives.reach import ReachMemory

Band = tuple[float, float]

EVERYWHERE: Sequence[Band] = ((-math.inf, math.inf),)
PINCHES = (Approach(0.0, math.radians(30.0)), Approach(0.0, math.pi / 2))
SLACK_M = 1e-9


class WideMemory:
    """Nothing has to be queried or kept."""

    queries, query_time_s = 0, 0.0

    def forget(self) -> None: ...

    def share(self) -> None: ...


NO_MEMORY = WideMemory()


@dataclass(frozen=True)
class WideReach:
    """The reach of two arms, each in every approach to each point whose x in the base frame is in one of its bands (m).

    The left arm's bands are the right arm's too, unless that has its own.
    """

    left: Sequence[Band] = EVERYWHERE
    right: Sequence[Band] | None = None
    approaches: tuple[Approach, ...] = PINCHES

    arm_names: tuple[str, ...] = ("left", "right")
    shoulders: tuple[Point3, ...] = ((-0.05, 0.19, 0.97), (-0.05, -0.19, 0.97))
    comfort_m: float = 0.0
    memory: ReachMemory = NO_MEMORY

    def short_by_m(self, arm: int, x_m: float) -> float:
        bands = self.left if arm == 0 or self.right is None else self.right
        short_by_m = min((max(low - x_m, x_m - high, 0.0) for low, high in bands), default=math.inf)
        return 0.0 if short_by_m < SLACK_M else short_by_m

    def seen(self, arm: int, points: FloatArray, count: int) -> BoolArray:
        """Return which points are in reach from which standoffs, shape (points, count)."""
        return np.array(
            [[self.short_by_m(arm, x + j * STANDOFF_STEP_M) == 0.0 for j in range(count)] for x in points[:, 0]]
        )

    def standoffs(
        self,
        path: ReachQuery,
        *,
        start: int | None = None,
        end: int | None = None,
        among: NDArray[np.uint32] | None = None,
    ) -> NDArray[np.uint32]:
        """Ignore `end` and `among`, which only allow a reach to look at less."""
        seen, shape = self.seen(path.arm, path.points, path.count), (len(path.approaches), len(path.points))
        row = connected([sum(1 << int(j) for j in np.flatnonzero(of_point)) for of_point in seen], path.count, start)
        return np.array([row] * len(path.approaches), dtype=np.uint32).reshape(shape)

    def following(self, paths: Sequence[ReachQuery]) -> "WideFollowing":
        return WideFollowing(self, paths)

    def from_anywhere(self, places: ReachQuery) -> BoolArray:
        is_seen = self.seen(places.arm, places.points, places.count).any(axis=1)
        return np.tile(is_seen, (len(places.approaches), 1))

    def at_least_short(self, ways: ReachQuery) -> FloatArray:
        """Know no bound."""
        return np.zeros(len(ways.points))

    def shortfall(
        self, places: ReachQuery, at_most_m: float = math.inf, deadline: Deadline = ENDLESS
    ) -> Shortfall | None:
        short_by_m = np.array([[self.short_by_m(places.arm, x) for x in place[:, 0]] for place in places.points])
        nearest = short_by_m.argmin(axis=1)
        worst = int(short_by_m.min(axis=1).argmax())
        least_m = float(short_by_m[worst, nearest[worst]])
        if least_m == 0.0:
            return None
        seen_from, approach = int(nearest[worst]), int(places.approaches[0])
        return Shortfall("too_far", None, least_m, False, (-1.0, 0.0, 0.0), approach, seen_from, place=worst)


@dataclass(frozen=True)
class WideFollowing:
    """Hands of such a robot on their paths: every approach is as good, so the first of each hand will do."""

    reach: WideReach
    paths: Sequence[ReachQuery]

    def __call__(self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten") -> Driving:
        """Return all ways by relaxation over waypoints and standoffs; `most` is ignored."""
        count = len(begun)
        seen = np.all([self.reach.seen(path.arm, path.points, count) for path in self.paths], axis=0)
        first = np.arange(count)
        steps = begun.copy()
        for is_good in seen:
            steps = np.where(is_good, steps, IMPOSSIBLE)
            for _ in range(count):
                for j, beside in [(j, j + side) for j in range(count) for side in (-1, 1) if 0 <= j + side < count]:
                    if is_good[j] and steps[beside] + 1 < steps[j]:
                        steps[j], first[j] = steps[beside] + 1, first[beside]
        if wanted == "unbeaten":
            driven = [
                min(steps[o] + abs(o - e) for o in range(count) if o != e) if count > 1 else IMPOSSIBLE
                for e in range(count)
            ]
            steps = np.where(steps < driven, steps, IMPOSSIBLE)
        steps = np.minimum(steps, IMPOSSIBLE)
        return Driving(steps, first, np.zeros((len(self.paths), count), dtype=np.int64), IMPOSSIBLE)


def connected(row: list[int], count: int, start: int | None = None) -> list[int]:
    """Return a row of masks without the standoffs that the base cannot have reached; all 0 if it gets stuck."""
    kept, before = [], (1 << count) - 1 if start is None else 1 << start
    for mask in row:
        stretches, at = [], 0
        for j in range(count + 1):
            if j < count and mask >> j & 1:
                at |= 1 << j
            elif at:
                stretches.append(at)
                at = 0
        before = sum(s for s in stretches if s & before)
        kept.append(before)
    return kept if before else [0] * len(row)
