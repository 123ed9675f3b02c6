"""A camera's position, direction and field of view."""

from dataclasses import dataclass

from planner.geometry.pose import Point3

FOV_RAD = 0.72
"""The usual vertical field of view (rad)."""


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """A viewpoint; up in the picture is up in the world. Table frame.

    Attributes:
        position: the camera (m).
        look_at: the middle of the picture (m).
        fov_rad: the vertical field of view (rad).
    """

    position: Point3
    look_at: Point3
    fov_rad: float = FOV_RAD
