"""Where a robot stands, and how it holds its arms."""

from collections.abc import Mapping
from dataclasses import dataclass

from planner.geometry.pose import Pose2


@dataclass(frozen=True, slots=True)
class Posture:
    """A robot's base and joints.

    Attributes:
        base: its base, table frame.
        joints: its joints by their URDF names (rad; m for prismatic ones).
    """

    base: Pose2
    joints: Mapping[str, float]
