"""The point on the cloth that a pointer points at: its ray intersected with the cloth's plane."""

import math
from dataclasses import dataclass

from planner.geometry.pose import Point2, Point3

CLOTH_HEIGHT_M = 0.0015
"""Height of the plane in which the cloth lies (m above the table)."""


@dataclass(frozen=True, slots=True)
class Aim:
    """A point that the pointer points at.

    Attributes:
        point: where the ray meets the cloth's plane, table frame (m).
        pixel_m: the distance between neighbouring pixels there, across the line of sight (m).
    """

    point: Point2
    pixel_m: float


def aim(eye: Point3, through: Point3, pixel_rad: float) -> Aim | None:
    """Return where a ray meets the cloth's plane.

    Args:
        eye: where the ray begins, table frame (m).
        through: a point further along it (m).
        pixel_rad: the angle that one pixel covers (rad).

    Returns:
        The aim; None for a ray that goes up, is level, begins below the plane, or has no direction.
    """
    if not all(math.isfinite(place) for place in (*eye, *through)):
        return None
    drop_m, height_m = eye[2] - through[2], eye[2] - CLOTH_HEIGHT_M
    if drop_m <= 0.0 or height_m <= 0.0:
        return None
    share = height_m / drop_m
    x, y = (start + share * (end - start) for start, end in zip(eye[:2], through[:2], strict=True))
    return Aim((x, y), math.dist(eye, (x, y, CLOTH_HEIGHT_M)) * pixel_rad)


def pixel_angle(fov_rad: float, height_px: int) -> float:
    """Return the angle that one pixel covers (rad), from the vertical field of view (rad) and the picture's height."""
    return 2.0 * math.tan(fov_rad / 2.0) / max(height_px, 1)
