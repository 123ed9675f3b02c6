"""The camera of a robot's card: over the table, or on one of the robot's links."""

import math

import numpy as np

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import RobotShape
from planner.geometry.pose import FloatArray
from planner.geometry.table import Table
from planner.robots.card_parts import CameraFile

_OVER_M = 2.0
_MARGIN = 1.1
_SIZE_PX = (640, 480)


def overhead(table: Table) -> CameraFile:
    """Return the camera of a card that names none: 2 m over the table's middle, with all of the table in its picture.

    The picture's longer side is along the table's longer one.
    """
    is_deep = table.depth_m >= table.width_m
    across, down = (table.depth_m, table.width_m) if is_deep else (table.width_m, table.depth_m)
    half_m = _MARGIN / 2.0 * max(across, down * _SIZE_PX[0] / _SIZE_PX[1])
    return CameraFile(
        z_m=_OVER_M,
        roll_rad=math.pi,
        yaw_rad=0.0 if is_deep else math.pi / 2.0,
        width_px=_SIZE_PX[0],
        height_px=_SIZE_PX[1],
        field_of_view_rad=2.0 * math.atan(half_m / _OVER_M),
    )


def hung(given: CameraFile) -> Camera:
    """Return a camera whose pose is in the table's frame."""
    return Camera.at(_pose(given), (given.width_px, given.height_px), given.field_of_view_rad)


def camera_of(given: CameraFile, shape: RobotShape, posture: Posture) -> Camera:
    """Return where a camera is while the robot has a posture.

    Raises:
        KeyError: the robot has no link of the camera's name.
    """
    if given.link is None:
        return hung(given)
    mounted = shape.frames(posture)[given.link]
    return Camera.at(mounted @ _pose(given), (given.width_px, given.height_px), given.field_of_view_rad)


def _pose(given: CameraFile) -> FloatArray:
    """Return a camera's pose in the frame it is mounted in, shape (4, 4): roll, pitch, yaw as in a URDF."""
    (cr, cp, cy), (sr, sp, sy) = (
        [turn(angle) for angle in (given.roll_rad, given.pitch_rad, given.yaw_rad)] for turn in (math.cos, math.sin)
    )
    pose = np.eye(4)
    pose[:3, :3] = [
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    ]
    pose[:3, 3] = (given.x_m, given.y_m, given.z_m)
    return pose
