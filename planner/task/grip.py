"""A grip in a plan, and the base's place: what every primitive reports."""

from dataclasses import dataclass
from typing import Any

from planner.geometry.pose import Point3, Pose2


@dataclass(frozen=True, slots=True)
class Grip:
    """Where one arm's tool frame goes, table frame (m).

    Attributes:
        arm: the arm's name.
        pick: where the cloth is taken, or held from the start.
        apex: the highest point of a fold's path; None in a drag.
        place: where the path ends.
    """

    arm: str
    pick: Point3
    apex: Point3 | None
    place: Point3

    def to_dict(self) -> dict[str, Any]:
        """The grip as JSON."""
        apex = None if self.apex is None else list(self.apex)
        return {"arm": self.arm, "pick": list(self.pick), "apex": apex, "place": list(self.place)}


@dataclass(frozen=True, slots=True)
class BaseStop:
    """Where a primitive leaves the base.

    Attributes:
        station: the station's name.
        back_off_m: how far the base has backed off from it (m).
        pose: the base in the table frame.
    """

    station: str
    back_off_m: float
    pose: Pose2

    def to_dict(self) -> dict[str, Any]:
        """The stop as JSON."""
        return {"station": self.station, "back_off_m": self.back_off_m, **self.pose.to_dict()}
