"""Where a stack is expected to lie before it is looked for."""

import math
from dataclasses import dataclass, replace

from planner.geometry.pose import Pose2


@dataclass(frozen=True, slots=True)
class Expected:
    """A placement and how sure it is: standard deviations each way and of the angle.

    Attributes:
        placement: the article frame in the table frame.
        within_m: of its place (m). Laid down by hand, or dragged, cloth is within some centimetres of where it ought to
            be.
        within_rad: of its angle (rad).
    """

    placement: Pose2
    within_m: float = 0.03
    within_rad: float = 0.08

    def loosened(self, by_m: float, by_rad: float) -> "Expected":
        """Return the same after something may have moved it by so much more (standard deviations)."""
        return replace(self, within_m=math.hypot(self.within_m, by_m), within_rad=math.hypot(self.within_rad, by_rad))
