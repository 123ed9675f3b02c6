"""What the primitives ask of a robot. They own the question; `planner.robot` answers it."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.shortfall import Shortfall


class Reach(Protocol):
    """The reach of one robot with its lift at one height, to one comfort radius (paper, section 8).

    Arms are numbered from left to right as the robot sees them; `arm_names` has their names.
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

    def from_anywhere(
        self, arm: int, points: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
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

        Returns:
            Truths, shape (k, n).
        """
        ...

    def shortfall(self, arm: int, point: FloatArray, approaches: NDArray[np.int64]) -> Shortfall | None:
        """Why, and by how much, a point is not in comfortable reach, in the best of some approaches.

        Args:
            arm: index into `arm_names`.
            point: the tool's place in the base frame, z above the floor (m), shape (3,).
            approaches: indices into `approaches`, shape (k,), at least one.

        Returns:
            The smallest shortfall; None where the point is in comfort in one of the approaches.
        """
        ...
