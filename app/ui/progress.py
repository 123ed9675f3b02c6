"""Where the article lies and which folds are done, primitive by primitive."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from planner.geometry.pose import Pose2


@dataclass(frozen=True, slots=True)
class Stint:
    """One primitive of a plan, as the stage needs it.

    Attributes:
        primitive: as in the plan's JSON.
        placement: the article's placement when it begins.
        done: the folds done when it begins.
    """

    primitive: Mapping[str, Any]
    placement: Pose2
    done: frozenset[int]

    @property
    def fold(self) -> int | None:
        """The fold under way, if it is one."""
        fold = self.primitive.get("fold")
        return None if fold is None else int(fold)

    @property
    def end_s(self) -> float:
        """When it ends (s)."""
        return float(self.primitive["start_s"]) + float(self.primitive["duration_s"])

    def placement_with(self, base: Pose2) -> Pose2:
        """The article's placement while the base stands there.

        A drag pulls the cloth along for the last `distance_m` of the base's way.
        """
        if self.primitive["kind"] != "drag":
            return self.placement
        end, distance_m = self.primitive["base"], float(self.primitive["distance_m"])
        left_m = min(distance_m, math.hypot(base.x_m - end["x_m"], base.y_m - end["y_m"]))
        pulled_m = distance_m - left_m
        yaw_rad = float(end["yaw_rad"])
        return self.placement.moved(-pulled_m * math.cos(yaw_rad), -pulled_m * math.sin(yaw_rad))

    @property
    def placement_after(self) -> Pose2:
        """The article's placement when the primitive has ended."""
        end = self.primitive["base"]
        return self.placement_with(Pose2(end["x_m"], end["y_m"], end["yaw_rad"]))

    @property
    def done_after(self) -> frozenset[int]:
        """The folds done when it has ended."""
        return self.done if self.fold is None else self.done | {self.fold}


def stints(placement: Pose2, primitives: Sequence[Mapping[str, Any]]) -> tuple[Stint, ...]:
    """The primitives of a plan with what was true when each began."""
    found: list[Stint] = []
    done: frozenset[int] = frozenset()
    for primitive in primitives:
        stint = Stint(primitive, placement, done)
        found.append(stint)
        placement, done = stint.placement_after, stint.done_after
    return tuple(found)
