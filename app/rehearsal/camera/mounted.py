"""The cameras of a robot: that of its card, over the table or on one of its links, and those on its wrists."""

import math
from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import RobotShape
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.robots.card_file import CardFile
from planner.robots.card_parts import CameraFile

_OVER_M = 2.0
_MARGIN = 1.1
_SIZE_PX = (640, 480)

_BEHIND_M, _ABOVE_M = 0.1, 0.06
"""Where the lens of a wrist's camera is: behind the point between the fingertips, and above it (m)."""

_WRIST_VIEW_RAD = 1.3


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


def wrists(
    card: CardFile, shape: RobotShape, home: Mapping[str, float], size_px: tuple[int, int]
) -> dict[str, CameraFile]:
    """Return a camera on each wrist by the arm's name: it looks at the point between the fingertips.

    Args:
        card: the robot's card.
        shape: the robot's shape.
        home: its joints at home, where the cameras are above their hands (rad, m).
        size_px: the width and height of their pictures.
    """
    frames, found = shape.frames(Posture(Pose2(0.0, 0.0, 0.0), home)), {}
    for arm in card.arms:
        tool = arm.tool
        approach = np.array(tool.approach) / np.linalg.norm(tool.approach)
        across = np.cross(approach, np.array(tool.closing))
        across /= math.copysign(float(np.linalg.norm(across)), (frames[tool.link][:3, :3] @ across)[2])
        ahead = _BEHIND_M * approach - _ABOVE_M * across
        x_m, y_m, z_m = (np.array(tool.offset_m) - ahead).tolist()
        ahead /= np.linalg.norm(ahead)
        right = np.cross(approach, across)
        axes = np.column_stack([right, np.cross(ahead, right), ahead])
        roll_rad, pitch_rad, yaw_rad = Rotation.from_matrix(axes).as_euler("xyz").tolist()
        found[arm.name] = CameraFile(x_m, y_m, z_m, roll_rad, pitch_rad, yaw_rad, *size_px, _WRIST_VIEW_RAD, tool.link)
    return found


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
