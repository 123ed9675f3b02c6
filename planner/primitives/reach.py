"""The protocol for queries about a robot's reach. The primitives own it; `planner.robots` implements it."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.reach_query import ReachQuery, Shortfall


class Following(Protocol):
    """A query about hands that follow paths: how the base may drive meanwhile."""

    def __call__(self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten") -> Driving:
        """Return how the base may drive meanwhile, in as few steps as possible.

        Args:
            begun: for each standoff the steps in which the base can be there when the hands begin; `IMPOSSIBLE` where
                it cannot. Shape (count,), count at most 32.
            most: the most steps of a way; longer ones are not looked for.
            wanted: which ends are wanted.
        """
        ...


class ReachMemory(Protocol):
    """The cache behind the reach of one plan, and its counters, for whoever makes the plan; no answer depends on it."""

    @property
    def queries(self) -> int:
        """The number of queries put to the exact inverse-kinematics kernel so far, comfort points counted."""
        ...

    @property
    def query_time_s(self) -> float:
        """The time spent in them (s)."""
        ...

    def forget(self) -> None:
        """Leave the cache to another plan and keep the counters."""
        ...

    def share(self) -> None:
        """Let the next plan know what is cached so far; it is charged for the same queries."""
        ...


class Reach(Protocol):
    """The reach of one robot with its lift at one height, to one comfort radius (paper, section 8).

    Arms are numbered from left to right as the robot sees them; `arm_names` has their names. Standoffs are those of the
    grid, one every `STANDOFF_STEP_M`, from 0 on.
    """

    @property
    def arm_names(self) -> tuple[str, ...]:
        """The arms from left to right."""
        ...

    @property
    def approaches(self) -> tuple[Approach, ...]:
        """The directions from which this robot's grippers may pinch cloth, base frame."""
        ...

    @property
    def comfort_m(self) -> float:
        """The comfort radius: a point counts as reachable only if a circle of this radius round it is (m)."""
        ...

    @property
    def shoulders(self) -> tuple[Point3, ...]:
        """The position of each shoulder, base frame (m); for telling near from far, not for reach."""
        ...

    @property
    def memory(self) -> ReachMemory:
        """The cache of answers, and the counters of queries."""
        ...

    def standoffs(
        self,
        path: ReachQuery,
        *,
        start: int | None = None,
        end: int | None = None,
        among: NDArray[np.uint32] | None = None,
    ) -> NDArray[np.uint32]:
        """Return, for each approach, the standoffs at which the base may stand while the arm's tool follows a path.

        The tool keeps one orientation. At each point the base may drive while the tool rests there, if the tool is
        within the comfort radius at every standoff on the way. So a standoff counts at a point if the base was there at
        the point before, or can drive there; at the first point every standoff within the comfort radius counts.

        Args:
            path: the path's points, shape (n, 3), and at most 32 standoffs.
            start: the standoff at which the base stands when the tool is at the first point already; None: the tool is
                brought there once the base stands wherever is best.
            end: the standoff at which the base is to be in the end; None: any.
            among: bit masks of the standoffs that matter at each point, shape (n,): the base does not stand at others.
                None: all.

        Returns:
            Bit masks, shape (k, n): bit j is set where the base may have backed off by j steps. Where the path cannot
            be followed to its end, that approach's whole row is 0.
        """
        ...

    def following(self, paths: Sequence[ReachQuery]) -> Following:
        """Return a query about hands that follow paths, each in one approach.

        At every waypoint the base may drive while the hands rest there, if every hand is within the comfort radius at
        every standoff on the way.

        Args:
            paths: for each hand its path, shape (n, 3), n being the same for all. The standoffs are those of the query.
        """
        ...

    def from_anywhere(self, places: ReachQuery) -> BoolArray:
        """Return, for each approach, which points the arm's tool can reach from at least one standoff.

        A point is reached if it is within the comfort radius. Each point stands on its own: no path leads to it.

        Args:
            places: the points, shape (n, 3), and any number of standoffs.

        Returns:
            Truth values, shape (k, n).
        """
        ...

    def at_least_short(self, ways: ReachQuery) -> FloatArray:
        """Return a lower bound on the shortfall of the points of each way (m), shape (n,): 0 where none is known.

        It is much cheaper than the exact result.

        Args:
            ways: the points of each way, shape (n, p, 3); the best approach and the best standoff count.
        """
        ...

    def shortfall(
        self, places: ReachQuery, at_most_m: float = math.inf, deadline: Deadline = ENDLESS
    ) -> Shortfall | None:
        """Return by how much and why the worst of places that one approach must reach is not within the comfort radius.

        Args:
            places: the tool at each place, as seen from each of the places where the base may stand, shape (p, n, 3).
                The approach is at least one; that in which the shortfall is smallest counts. It has no standoffs.
            at_most_m: the longest displacement to look for (m).
            deadline: once it is long over, the best of the approaches examined by then, or a lower bound, will do.

        Returns:
            The shortfall; None where some approach has all places within the comfort radius. Where `at_most_m` or more
            is lacking at one of several places, or the result is a lower bound, only that fact is valid, not the other
            details of the answer.
        """
        ...


class UnlimitedReach:
    """The reach of a robot as if every place were within the comfort radius from everywhere; see `Reach`.

    No robot has such arms. They show whether reach is the only obstacle to a fold.
    """

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
        """Return the query about hands that can follow any path from anywhere, with the first approach of each."""
        return partial(_driven_anywhere, len(paths))

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


def _driven_anywhere(
    hands: int, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
) -> Driving:
    """Keep the base where it is when the hands begin, or drive it from there to every end if `wanted` says so."""
    places = np.arange(len(begun))
    steps, first = begun.copy(), places
    if wanted == "every":
        ways = begun[:, None] + np.abs(places[:, None] - places)
        first, steps = ways.argmin(axis=0), ways.min(axis=0)
    more = int(steps.min(where=steps > most, initial=IMPOSSIBLE))
    steps = np.where(steps <= most, steps, IMPOSSIBLE)
    return Driving(steps, first, np.zeros((hands, len(begun)), dtype=np.int64), more)
