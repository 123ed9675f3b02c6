"""Places of an arm's tool whose reach is queried, and by how much and why one of them is out of reach."""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray, Point3
from planner.geometry.tolerance import LENGTH_M


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


Cause: TypeAlias = Literal["too_far", "too_near", "joint_limit", "comfort_only", "own_body"]
"""Why a place is out of reach: it should be nearer to the shoulder, further from it, or elsewhere at the same distance;
or the tool can be there, but not everywhere within the comfort radius around it; or the joints would allow it, but the
robot's own body is in the way."""


@dataclass(frozen=True, slots=True)
class Shortfall:
    """The least shortfall of a tool at a point with the comfort radius, over all approaches.

    A case is a place that the point is seen from and an approach.

    Attributes:
        cause: what is wrong.
        joint: the joint that limits, in plain words; None where the point is beyond the arm's length.
        short_by_m: how far the point would have to be displaced to be in reach with its comfort radius (m).
        is_at_least: whether no displacement that was tried helps, so that `short_by_m` is only a lower bound.
        towards: the unit direction of the displacement, base frame.
        approach: the index of the approach.
        seen_from: the index of the place from which it was seen.
        comfort_m: with "comfort_only" the radius of the largest circle round it that the tool reaches (m); else None.
        place: the index of the place that is short, of several that one approach must reach.
    """

    cause: Cause
    joint: str | None
    short_by_m: float
    is_at_least: bool
    towards: Point3
    approach: int
    seen_from: int
    comfort_m: float | None = None
    place: int = 0

    def __post_init__(self) -> None:
        """Refuse an unknown cause, an invalid distance, and a direction that is not of unit length (`ValueError`)."""
        if self.cause not in get_args(Cause):
            raise ValueError(f"{self.cause!r} is no cause, only {', '.join(get_args(Cause))}")
        if not (math.isfinite(self.short_by_m) and self.short_by_m >= 0.0):
            raise ValueError(f"a place cannot be short by {self.short_by_m} m")
        if not abs(math.hypot(*self.towards) - 1.0) <= LENGTH_M:
            raise ValueError(f"{self.towards} is no unit direction")
        if (self.comfort_m is None) == (self.cause == "comfort_only"):
            raise ValueError(f"a place with cause {self.cause} has no comfort of {self.comfort_m} m")
