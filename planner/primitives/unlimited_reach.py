"""Arms of unlimited length, within whose reach everything lies.

No robot has them. They show whether reach is the only obstacle to a fold.
"""

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.shortfall import Shortfall
from planner.primitives.reach import Following, Reach


class UnlimitedReach:
    """The reach of a robot as if every place were within the comfort radius from everywhere; see `Reach`."""

    queries, query_time_s = 0, 0.0

    def __init__(self, robot: Reach, more_hands: int = 0) -> None:
        """Copy the names and approaches of a robot's arms, and add `more_hands` arms."""
        self.arm_names: tuple[str, ...] = (*robot.arm_names, *(f"extra {n + 1}" for n in range(more_hands)))
        self.approaches: tuple[Approach, ...] = robot.approaches
        self.comfort_m: float = robot.comfort_m
        self.shoulders: tuple[Point3, ...] = (*robot.shoulders, *robot.shoulders[-1:] * more_hands)

    def forget(self) -> None:
        """Do nothing: there are no caches."""

    def share(self) -> None:
        """Do nothing: nothing has to be asked."""

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
        """Return every standoff that matters, for each approach and point."""
        masks = np.full((len(approaches), len(points)), (1 << count) - 1, dtype=np.uint32)
        return masks if among is None else masks & among

    def following(
        self, arms: tuple[int, ...], paths: FloatArray, approaches: tuple[NDArray[np.int64], ...], step_m: float
    ) -> Following:
        """Return hands that can follow any path from anywhere."""
        return _Unlimited(len(arms))

    def from_anywhere(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
    ) -> BoolArray:
        """Return true for each approach and point."""
        return np.ones((len(approaches), len(points)), dtype=bool)

    def at_least_short(
        self, arm: int, ways: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> FloatArray:
        """Return zeros: nothing is lacking."""
        return np.zeros(len(ways))

    def shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = np.inf,
        deadline: Deadline = ENDLESS,
    ) -> Shortfall | None:
        """Return None: nothing is lacking."""
        return None

    def shortfall_together(
        self,
        arm: int,
        places: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = np.inf,
        deadline: Deadline = ENDLESS,
    ) -> tuple[int, Shortfall] | None:
        """Return None: nothing is lacking."""
        return None


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
