"""Where a pointer points: its ray, met with the plane in which the cloth lies."""

import math
from dataclasses import dataclass

from planner.geometry.pose import Point2, Point3

CLOTH_HEIGHT_M = 0.0015
"""The plane in which the cloth lies (m above the table)."""


@dataclass(frozen=True, slots=True)
class Aim:
    """A place that is pointed at.

    Attributes:
        point: where the ray meets the plane of the cloth, table frame (m).
        pixel_m: how far apart two neighbouring pixels are there, across the line of sight (m).
    """

    point: Point2
    pixel_m: float


def aim(eye: Point3, through: Point3, pixel_rad: float) -> Aim | None:
    """Where a ray meets the plane of the cloth.

    Args:
        eye: where the ray begins, table frame (m).
        through: a point further along it (m).
        pixel_rad: the angle under which the eye sees one pixel (rad).

    Returns:
        None for a ray that goes up, level, or begins below the plane, and for one that is none.
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
    """The angle under which a camera sees one pixel (rad), from its vertical field of view (rad) and its height."""
    return 2.0 * math.tan(fov_rad / 2.0) / max(height_px, 1)
