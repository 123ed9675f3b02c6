"""A stand-in for a robot's reach: arms that reach everything, or what lies in bands ahead of the base."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.shortfall import Shortfall

Band = tuple[float, float]

EVERYWHERE: Sequence[Band] = ((-math.inf, math.inf),)
PINCHES = (Approach(0.0, math.radians(30.0)), Approach(0.0, math.pi / 2))
SLACK_M = 1e-9


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
    queries: int = 0
    query_time_s: float = 0.0

    def share(self) -> None:
        pass

    def forget(self) -> None:
        pass

    def short_by_m(self, arm: int, x_m: float) -> float:
        bands = self.left if arm == 0 or self.right is None else self.right
        short_by_m = min((max(low - x_m, x_m - high, 0.0) for low, high in bands), default=math.inf)
        return 0.0 if short_by_m < SLACK_M else short_by_m

    def seen(self, arm: int, points: FloatArray, count: int, step_m: float) -> BoolArray:
        """Return which points are in reach from which standoffs, shape (points, count)."""
        return np.array([[self.short_by_m(arm, x + j * step_m) == 0.0 for j in range(count)] for x in points[:, 0]])

    def standoffs(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
        start: int | None = None,
        end: int | None = None,
        among: NDArray[np.uint32] | None = None,
    ) -> NDArray[np.uint32]:
        """Ignore `end` and `among`, which only allow a reach to look at less."""
        masks = [sum(1 << int(j) for j in np.flatnonzero(row)) for row in self.seen(arm, points, count, step_m)]
        row = connected(masks, count, start)
        return np.array([row] * len(approaches), dtype=np.uint32).reshape(len(approaches), len(points))

    def following(
        self, arms: tuple[int, ...], paths: FloatArray, approaches: tuple[NDArray[np.int64], ...], step_m: float
    ) -> "WideFollowing":
        return WideFollowing(self, arms, paths, step_m)

    def from_anywhere(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
    ) -> BoolArray:
        return np.tile(self.seen(arm, points, count, step_m).any(axis=1), (len(approaches), 1))

    def at_least_short(
        self, arm: int, ways: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> FloatArray:
        """Know no bound."""
        return np.zeros(len(ways))

    def shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> Shortfall | None:
        short_by_m = [self.short_by_m(arm, x) for x in points[:, 0]]
        nearest = int(np.argmin(short_by_m))
        if short_by_m[nearest] == 0.0:
            return None
        return Shortfall("too_far", None, short_by_m[nearest], False, (-1.0, 0.0, 0.0), int(approaches[0]), nearest)

    def shortfall_together(
        self,
        arm: int,
        places: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> tuple[int, Shortfall] | None:
        each = [(n, self.shortfall(arm, place, approaches)) for n, place in enumerate(places)]
        found = [(n, one) for n, one in each if one is not None]
        return max(found, key=lambda pair: pair[1].short_by_m, default=None)


@dataclass(frozen=True)
class WideFollowing:
    """Hands of such a robot on their paths: every approach is as good, so the first of each hand will do."""

    reach: WideReach
    arms: tuple[int, ...]
    paths: FloatArray
    step_m: float

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """Return all ways by relaxation over waypoints and standoffs; `most` is ignored."""
        count = len(begun)
        hands = zip(self.arms, self.paths, strict=True)
        seen = np.all([self.reach.seen(arm, path, count, self.step_m) for arm, path in hands], axis=0)
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
        return Driving(steps, first, np.zeros((len(self.arms), count), dtype=np.int64), IMPOSSIBLE)


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
