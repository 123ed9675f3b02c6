"""Where a camera is."""

from dataclasses import dataclass

from planner.geometry.pose import Point3


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """A place to look from; up in the picture is up in the world. Table frame.

    Attributes:
        position: the camera (m).
        look_at: the middle of the picture (m).
    """

    position: Point3
    look_at: Point3
