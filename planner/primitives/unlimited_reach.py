"""Arms of any length: the answer to every question about reach is yes.

No robot has them. They tell whether reach is all that stands in the way of a fold.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.shortfall import Shortfall
from planner.primitives.reach import Following, Reach


class UnlimitedReach:
    """The reach of a robot as if every place were in comfort from everywhere; see `Reach`."""

    queries, query_time_s = 0, 0.0

    def __init__(self, robot: Reach, more_hands: int = 0) -> None:
        """As many arms as a robot has, by the same names, and some more; grippers turn as the robot's do."""
        self.arm_names: tuple[str, ...] = (*robot.arm_names, *(f"extra {n + 1}" for n in range(more_hands)))
        self.approaches: tuple[Approach, ...] = robot.approaches
        self.comfort_m: float = robot.comfort_m
        self.shoulders: tuple[Point3, ...] = (*robot.shoulders, *robot.shoulders[-1:] * more_hands)

    def forget(self) -> None:
        """Nothing is remembered."""

    def back_offs(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
        start: int | None = None,
    ) -> NDArray[np.uint32]:
        """Every back-off, for each approach and point."""
        return np.full((len(approaches), len(points)), (1 << count) - 1, dtype=np.uint32)

    def following(
        self, arms: tuple[int, ...], paths: FloatArray, approaches: tuple[NDArray[np.int64], ...], step_m: float
    ) -> Following:
        """Hands that can follow any path from anywhere."""
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
        """Always."""
        return np.ones((len(approaches), len(points)), dtype=bool)

    def at_least_short(
        self, arm: int, ways: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> FloatArray:
        """Nothing is lacking."""
        return np.zeros(len(ways))

    def shortfall(
        self, arm: int, points: FloatArray, approaches: NDArray[np.int64], at_most_m: float = np.inf
    ) -> Shortfall | None:
        """Nothing is lacking."""
        return None

    def shortfall_together(
        self, arm: int, places: FloatArray, approaches: NDArray[np.int64], at_most_m: float = np.inf
    ) -> tuple[int, Shortfall] | None:
        """Nothing is lacking."""
        return None


class _Unlimited:
    """Hands that can follow any path; the first approach of each will do."""

    def __init__(self, hands: int) -> None:
        self._hands = hands

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """The base stays where it is when the hands begin, or goes on from there to every end if that is wanted."""
        places = np.arange(len(begun))
        steps, first = begun.copy(), places
        if wanted == "every":
            ways = begun[:, None] + np.abs(places[:, None] - places)
            first, steps = ways.argmin(axis=0), ways.min(axis=0)
        more = int(steps.min(where=steps > most, initial=IMPOSSIBLE))
        steps = np.where(steps <= most, steps, IMPOSSIBLE)
        return Driving(steps, first, np.zeros((self._hands, len(begun)), dtype=np.int64), more)
