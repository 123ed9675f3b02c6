"""The protocol for queries about a robot's reach. The primitives own it; `planner.robots` implements it."""

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.shortfall import Shortfall


class Following(Protocol):
    """A query about hands that follow paths."""

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """Return how the base may drive meanwhile, in as few steps as possible.

        Args:
            begun: for each standoff the steps in which the base can be there when the hands begin; `IMPOSSIBLE` where
                it cannot. Shape (count,), count at most 32.
            most: the most steps of a way; longer ones are not looked for.
            wanted: which ends are wanted.
        """
        ...


class Counted(Protocol):
    """The counters of a robot's reach, for budgets and the statistics of a plan."""

    @property
    def queries(self) -> int:
        """The number of queries put to the exact inverse-kinematics kernel so far, comfort points counted."""
        ...

    @property
    def query_time_s(self) -> float:
        """The time spent in them (s)."""
        ...


class Shortfalls(Protocol):
    """The shortfalls of places out of reach, for explanations."""

    def at_least_short(
        self, arm: int, ways: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> FloatArray:
        """Return a lower bound on the result of `shortfall_together` for the points of each way (m), shape (n,).

        It is 0 where no bound is known. It is much cheaper than the exact result.

        Args:
            arm: index into `arm_names`.
            ways: tool points in the base frame as it stands at standoff 0, z above the floor (m), shape (n, p, 3).
            approaches: indices into `approaches`, shape (k,); the best of them counts.
            count: the number of standoffs; the best of them counts.
            step_m: the distance between neighbouring standoffs (m).
        """
        ...

    def shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> Shortfall | None:
        """Return by how much and why a place is not within the comfort radius, in the best of some approaches.

        Args:
            arm: index into `arm_names`.
            points: the tool's place in the base frame, z above the floor (m), as seen from each of the places where the
                base may stand, shape (n, 3).
            approaches: indices into `approaches`, shape (k,), at least one.
            at_most_m: the longest displacement to look for (m).
            deadline: once it is long over, a lower bound will do.

        Returns:
            The smallest shortfall; None where the place is within the comfort radius from somewhere in one of the
                approaches.
        """
        ...

    def shortfall_together(
        self,
        arm: int,
        places: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> tuple[int, Shortfall] | None:
        """Return the worst of places that one approach must reach, in the approach in which that is mildest.

        Args:
            arm: index into `arm_names`.
            places: places of the tool, each as seen from each of the places where the base may stand, base frame, z
                above the floor (m), shape (p, n, 3).
            approaches: indices into `approaches`, shape (k,), at least one.
            at_most_m: the longest displacement to look for (m).
            deadline: once it is long over, the best of the approaches examined by then, or a lower bound, will do.

        Returns:
            The index of the place, and its shortfall in that approach; None where some approach has all places within
                the comfort radius. Where `at_most_m` or more is lacking, or the result is a lower bound, only that fact
                is valid, not the other details of the answer.
        """
        ...


class Reach(Counted, Shortfalls, Protocol):
    """The reach of one robot with its lift at one height, to one comfort radius (paper, section 8).

    Arms are numbered from left to right as the robot sees them; `arm_names` has their names.
    """

    @property
    def arm_names(self) -> tuple[str, ...]:
        """The arms from left to right."""
        ...

    def forget(self) -> None:
        """Drop all caches; answers stay the same."""
        ...

    def share(self) -> None:
        """Let the next plan know what has been asked so far; its answers and the queries charged stay the same."""
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
        """Return, for each approach, the standoffs at which the base may stand while the arm's tool follows a path.

        The tool keeps one orientation. At each point the base may drive while the tool rests there, if the tool is
        within the comfort radius at every standoff on the way. So a standoff counts at a point if the base was there at
        the point before, or can drive there; at the first point every standoff within the comfort radius counts.

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame as it stands at standoff 0, z above the floor (m), shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: the number of standoffs, at most 32.
            step_m: the distance between neighbouring standoffs (m).
            enough: how many approaches that can follow the path are enough, the first in the order given; the rows of
                others may be left 0. None: all are wanted.
            start: the standoff at which the base stands when the tool is at the first point already; None: the tool is
                brought there once the base stands wherever is best.
            end: the standoff at which the base is to be in the end; None: any.
            among: bit masks of the standoffs that matter at each point, shape (n,): the base does not stand at others.
                None: all.

        Returns:
            Bit masks, shape (k, n): bit j is set where the base may have backed off by j * step_m. Where the path
                cannot be followed to its end, that approach's whole row is 0.
        """
        ...

    def following(
        self, arms: tuple[int, ...], paths: FloatArray, approaches: tuple[NDArray[np.int64], ...], step_m: float
    ) -> Following:
        """Return a query about hands that follow paths, each in one approach.

        At every waypoint the base may drive while the hands rest there, if every hand is within the comfort radius at
        every standoff on the way.

        Args:
            arms: for each hand its index into `arm_names`.
            paths: for each hand its tool points in the base frame as it stands at standoff 0, z above the floor (m),
                shape (hands, n, 3).
            approaches: for each hand the indices into `approaches` that it may use, best first.
            step_m: the distance between neighbouring standoffs (m).
        """
        ...

    def from_anywhere(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
    ) -> BoolArray:
        """Return, for each approach, which points the arm's tool can reach from at least one standoff.

        A point is reached if it is within the comfort radius. Each point stands on its own: no path leads to it.

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame as it stands at standoff 0, z above the floor (m), shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: the number of standoffs.
            step_m: the distance between neighbouring standoffs (m).
            enough: how many approaches that reach every point are enough, the first in the order given; the rows of
                others may be left false. None: all are wanted.

        Returns:
            Truth values, shape (k, n).
        """
        ...
