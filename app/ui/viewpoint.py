"""Where a camera is."""

from dataclasses import dataclass

from planner.geometry.pose import Point3

FOV_RAD = 0.72
"""How much most cameras take in, from the bottom of the picture to its top."""


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """A place to look from; up in the picture is up in the world. Table frame.

    Attributes:
        position: the camera (m).
        look_at: the middle of the picture (m).
        fov_rad: how much it takes in, from the bottom of the picture to its top (rad).
    """

    position: Point3
    look_at: Point3
    fov_rad: float = FOV_RAD
