"""Places of an arm's tool whose reach is queried."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class ReachQuery:
    """Places of an arm's tool, and how it may come there.

    Attributes:
        arm: the arm's number, from left to right as the robot sees them.
        points: tool points in the base frame as it stands at standoff 0, z above the floor (m), shape (..., 3).
        approaches: the numbers of the approaches allowed, shape (k,), best first.
        count: how many standoffs of the grid there are.
    """

    arm: int
    points: FloatArray
    approaches: NDArray[np.int64]
    count: int = 1
