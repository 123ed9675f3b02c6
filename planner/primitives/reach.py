"""What the primitives ask of a robot. They own the question; `planner.robot` answers it."""

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.shortfall import Shortfall


class Following(Protocol):
    """Hands that are to follow paths."""

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """How the base may drive meanwhile, in as few steps as can be.

        Args:
            begun: for each back-off the steps in which the base can be there when the hands begin; `IMPOSSIBLE`
                where it cannot. Shape (count,), count at most 32.
            most: ways of more steps than this are not looked for.
            wanted: which ends are wanted.
        """
        ...


class Reach(Protocol):
    """The reach of one robot with its lift at one height, to one comfort radius (paper, section 8).

    Arms are numbered from left to right as the robot sees them; `arm_names` has their names.
    """

    @property
    def arm_names(self) -> tuple[str, ...]:
        """The arms from left to right."""
        ...

    def forget(self) -> None:
        """Drop what it remembers; its answers stay the same."""
        ...

    @property
    def approaches(self) -> tuple[Approach, ...]:
        """The directions from which this robot's grippers may pinch cloth, base frame."""
        ...

    @property
    def comfort_m(self) -> float:
        """A point counts as reachable only if a circle of this radius round it is (m)."""
        ...

    @property
    def shoulders(self) -> tuple[Point3, ...]:
        """Where each arm is hung up, base frame (m); for telling near from far, not for reach."""
        ...

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
        """For each approach, the back-offs at which the base may stand while the arm's tool follows a path.

        The tool keeps one orientation. At each point the base may drive while the tool rests there, if the tool is
        in comfort at every back-off on the way. So a back-off counts at a point if the base was there at the point
        before, or can drive there; at the first point every back-off in comfort counts.

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame as it stands at back-off 0, z above the floor (m),
                shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: how many back-offs there are, at most 32.
            step_m: from one back-off to the next (m).
            enough: so many approaches that can follow the path, the first in the order given, are enough, and
                the rows of others may be left 0; None: all are wanted.
            start: the back-off at which the base stands when the tool is at the first point already; None: the tool
                is brought there once the base stands wherever is best.

        Returns:
            Bit masks, shape (k, n): bit j is set where the base may have backed off by j * step_m. Where the
            path cannot be followed to its end, that approach's whole row is 0.
        """
        ...

    @property
    def queries(self) -> int:
        """Inverse-kinematics queries put to the exact kernel so far, comfort points counted."""
        ...

    @property
    def query_time_s(self) -> float:
        """Time spent in them (s)."""
        ...

    def following(
        self, arms: tuple[int, ...], paths: FloatArray, approaches: tuple[NDArray[np.int64], ...], step_m: float
    ) -> Following:
        """Hands that are to follow paths, each in one approach.

        At every waypoint the base may drive while the hands rest there, if every hand is in comfort at every back-off
        on the way.

        Args:
            arms: for each hand its index into `arm_names`.
            paths: for each hand its tool points in the base frame as it stands at back-off 0, z above the floor (m),
                shape (hands, n, 3).
            approaches: for each hand the indices into `approaches` that it may use, best first.
            step_m: from one back-off to the next (m).
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
        """For each approach, at which points the arm's tool is in comfort from at least one back-off.

        Each point stands on its own: there is no path that leads to it.

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame as it stands at back-off 0, z above the floor (m),
                shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: how many back-offs there are.
            step_m: from one back-off to the next (m).
            enough: so many approaches that have every point in comfort, the first in the order given, are enough, and
                the rows of others may be left false; None: all are wanted.

        Returns:
            Truths, shape (k, n).
        """
        ...

    def at_least_short(
        self, arm: int, ways: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> FloatArray:
        """A lower bound on what `shortfall_together` finds for the points of each way (m), shape (n,).

        0 where nothing can be said. Much cheaper.

        Args:
            arm: index into `arm_names`.
            ways: tool points in the base frame as it stands at back-off 0, z above the floor (m), shape (n, p, 3).
            approaches: indices into `approaches`, shape (k,); the best of them counts.
            count: how many back-offs there are; the best of them counts.
            step_m: from one back-off to the next (m).
        """
        ...

    def shortfall(
        self, arm: int, points: FloatArray, approaches: NDArray[np.int64], at_most_m: float = math.inf
    ) -> Shortfall | None:
        """Why, and by how much, a place is not in comfortable reach, in the best of some approaches.

        Args:
            arm: index into `arm_names`.
            points: the tool's place in the base frame, z above the floor (m), as seen from each of the places where
                the base may stand, shape (n, 3).
            approaches: indices into `approaches`, shape (k,), at least one.
            at_most_m: displacements longer than this need not be looked for (m).

        Returns:
            The smallest shortfall; None where the place is in comfort from somewhere in one of the approaches.
        """
        ...

    def shortfall_together(
        self, arm: int, places: FloatArray, approaches: NDArray[np.int64], at_most_m: float = math.inf
    ) -> tuple[int, Shortfall] | None:
        """Of places that are all to be had in one approach the worst, in the approach in which it is least so.

        Args:
            arm: index into `arm_names`.
            places: places of the tool, each as seen from each of the places where the base may stand, base frame,
                z above the floor (m), shape (p, n, 3).
            approaches: indices into `approaches`, shape (k,), at least one.
            at_most_m: displacements longer than this need not be looked for (m).

        Returns:
            Which place, and its shortfall in that approach; None where some approach brings all into comfort. Where
            `at_most_m` is lacking or more, nothing counts of the answer but that.
        """
        ...
