"""By how much a place is out of comfortable reach, and why."""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from planner.geometry.pose import Point3
from planner.geometry.tolerance import LENGTH_M

Cause: TypeAlias = Literal["too_far", "too_near", "joint_limit", "comfort_only"]
"""What is wrong with a place: it should be nearer to the shoulder, further from it, elsewhere at the same
distance; or the tool can be there, but not everywhere on the comfort circle round it."""


@dataclass(frozen=True, slots=True)
class Shortfall:
    """Why a tool cannot be at a point in comfort, in the approach that comes closest to it.

    Attributes:
        cause: what is wrong.
        joint: the joint that limits, in plain words; None where the point is beyond the arm's length.
        short_by_m: how far the point would have to be displaced (m); where no displacement that was tried
            helps, a number that it is at least. With "comfort_only" it is instead what the largest circle that
            the tool reaches lacks of the comfort radius.
        towards: the unit direction of the displacement, base frame.
        approach: index of the approach.
    """

    cause: Cause
    joint: str | None
    short_by_m: float
    towards: Point3
    approach: int

    def __post_init__(self) -> None:
        """Refuse an unknown cause, a distance that is none and a direction without length one (`ValueError`)."""
        if self.cause not in get_args(Cause):
            raise ValueError(f"{self.cause!r} is no cause, only {', '.join(get_args(Cause))}")
        if not (math.isfinite(self.short_by_m) and self.short_by_m >= 0.0):
            raise ValueError(f"a place cannot be short by {self.short_by_m} m")
        if not abs(math.hypot(*self.towards) - 1.0) <= LENGTH_M:
            raise ValueError(f"{self.towards} is no unit direction")
