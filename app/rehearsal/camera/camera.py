"""A pinhole camera over a table."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point3

_AHEAD_M = 1e-3
"""The least distance ahead of the lens; what is nearer or behind it counts as that far ahead (m)."""


@dataclass(frozen=True, slots=True)
class Camera:
    """A pinhole camera whose axis meets the middle of its picture.

    Attributes:
        position: the lens, table frame (m).
        rotation: its axes as columns in the table frame, x right, y down, z ahead; row by row.
        focal_px: the focal length (pixels).
        size_px: the image's width and height (pixels).
    """

    position: Point3
    rotation: tuple[Point3, Point3, Point3]
    focal_px: float
    size_px: tuple[int, int]

    @staticmethod
    def at(pose: FloatArray, size_px: tuple[int, int], field_of_view_rad: float) -> "Camera":
        """Return the camera at a pose.

        Args:
            pose: from the camera's axes (x right, y down, z ahead) to the table frame, shape (4, 4).
            size_px: the image's width and height.
            field_of_view_rad: the angle from the left edge of the image to its right edge.
        """
        focal_px = size_px[0] / 2.0 / math.tan(field_of_view_rad / 2.0)
        x, y, z = (_point(row) for row in pose[:3, :3])
        return Camera(_point(pose[:3, 3]), (x, y, z), focal_px, size_px)

    def pixels(self, points: FloatArray) -> FloatArray:
        """Return where points, shape (n, 3), m, are in the image, shape (n, 2); the first pixel's middle is at 0."""
        seen = (points - self.position) @ np.array(self.rotation)
        ahead = np.maximum(seen[:, 2:], _AHEAD_M)
        return np.asarray(self.focal_px * seen[:, :2] / ahead + self._middle)

    def depths(self, points: FloatArray) -> FloatArray:
        """Return the depths of points in front of the lens, shape (n, 3) -> (n,), m."""
        return np.asarray((points - self.position) @ np.array(self.rotation)[:, 2])

    def on_plane(self, pixels: FloatArray, height_m: float | FloatArray = 0.0) -> FloatArray:
        """Return where pixels, shape (n, 2), meet a plane over the table, shape (n, 2), m; NaN above the horizon.

        The height may be another one for each pixel, shape (n,).
        """
        rays = np.column_stack([(pixels - self._middle) / self.focal_px, np.ones(len(pixels))])
        ways = rays @ np.array(self.rotation).T
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (height_m - self.position[2]) / ways[:, 2]
        found = np.array(self.position)[:2] + share[:, None] * ways[:, :2]
        found[~(share > 0.0)] = np.nan
        return np.asarray(found)

    def all_on_table(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Return x and y of where each pixel meets the table, shape (height, width) each, m; NaN above the horizon."""
        (width, height), (column, row) = self.size_px, self._middle
        across = ((np.arange(width) - column) / self.focal_px)[None, :]
        down = ((np.arange(height) - row) / self.focal_px)[:, None]
        x, y, z = (right * across + below * down + ahead for right, below, ahead in self.rotation)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = -self.position[2] / z
        share[~(share > 0.0)] = np.nan
        return (self.position[0] + share * x).astype(np.float32), (self.position[1] + share * y).astype(np.float32)

    def carried(self, isometry: Isometry) -> "Camera":
        """Return the camera after the table frame was turned and shifted in its plane."""
        x, y = isometry.apply_point(self.position[:2])
        turned = isometry.apply(np.array(self.rotation)[:2].T) - np.array([isometry.x, isometry.y])
        (first, second), third = (_point(row) for row in turned.T), self.rotation[2]
        return replace(self, position=(x, y, self.position[2]), rotation=(first, second, third))

    @property
    def _middle(self) -> FloatArray:
        return (np.array(self.size_px) - 1.0) / 2.0


def _point(row: FloatArray) -> Point3:
    x, y, z = row.tolist()
    return (x, y, z)
