"""Arms of unlimited length, within whose reach everything lies.

No robot has them. They show whether reach is the only obstacle to a fold.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.reach_query import ReachQuery
from planner.primitives.reach import Following, Reach, ReachMemory


class UnlimitedReach:
    """The reach of a robot as if every place were within the comfort radius from everywhere; see `Reach`."""

    def __init__(self, robot: Reach, more_hands: int = 0) -> None:
        """Copy the names and approaches of a robot's arms, and add `more_hands` arms."""
        self.arm_names: tuple[str, ...] = (*robot.arm_names, *(f"extra {n + 1}" for n in range(more_hands)))
        self.approaches: tuple[Approach, ...] = robot.approaches
        self.comfort_m: float = robot.comfort_m
        self.shoulders: tuple[Point3, ...] = (*robot.shoulders, *robot.shoulders[-1:] * more_hands)
        self.memory: ReachMemory = _NoMemory()

    def standoffs(
        self,
        path: ReachQuery,
        *,
        start: int | None = None,
        end: int | None = None,
        among: NDArray[np.uint32] | None = None,
    ) -> NDArray[np.uint32]:
        """Return every standoff that matters, for each approach and point."""
        masks = np.full((len(path.approaches), len(path.points)), (1 << path.count) - 1, dtype=np.uint32)
        return masks if among is None else masks & among

    def following(self, paths: Sequence[ReachQuery]) -> Following:
        """Return hands that can follow any path from anywhere."""
        return _Unlimited(len(paths))

    def from_anywhere(self, places: ReachQuery) -> BoolArray:
        """Return true for each approach and point."""
        return np.ones((len(places.approaches), len(places.points)), dtype=bool)

    def at_least_short(self, ways: ReachQuery) -> FloatArray:
        """Return zeros: nothing is lacking."""
        return np.zeros(len(ways.points))

    def shortfall(self, places: ReachQuery, at_most_m: float = np.inf, deadline: Deadline = ENDLESS) -> None:
        """Return None: nothing is lacking."""


class _NoMemory:
    """Nothing has to be queried or kept."""

    queries, query_time_s = 0, 0.0

    def forget(self) -> None: ...

    def share(self) -> None: ...


class _Unlimited:
    """Hands that can follow any path with the first approach of each."""

    def __init__(self, hands: int) -> None:
        self._hands = hands

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """Keep the base where it is when the hands begin, or drive it from there to every end if that is wanted."""
        places = np.arange(len(begun))
        steps, first = begun.copy(), places
        if wanted == "every":
            ways = begun[:, None] + np.abs(places[:, None] - places)
            first, steps = ways.argmin(axis=0), ways.min(axis=0)
        more = int(steps.min(where=steps > most, initial=IMPOSSIBLE))
        steps = np.where(steps <= most, steps, IMPOSSIBLE)
        return Driving(steps, first, np.zeros((self._hands, len(begun)), dtype=np.int64), more)
