"""Preset viewpoints that show the table and what lies on it. Table frame, z up."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from app.drawing.drawing import Drawing
from app.drawing.ring import ring_of
from app.ui.robot_model import Link, load_robot_model
from app.ui.viewpoint import FOV_RAD, Viewpoint
from planner.geometry.pose import FloatArray, Point2, Point3, Pose2
from planner.geometry.table import Table, TableTop
from planner.robots.card import RobotCard

_MARGIN = 1.12
_TILT = 0.002  # a camera that looks straight down has no defined up direction
_EYES_OVER_FLOOR_M = 1.4
"""The height of the eye of a robot that has no head (m)."""
_AHEAD_OF_EYES_M = 0.15
_WIDEST_RAD = 1.9
_SIDE_CENTRE: Point3 = (-0.45, 0.0, 0.1)
_SIDE_HALF_M = (1.35, 0.85)
_SIDE_RISE = 0.12


@dataclass(frozen=True, slots=True)
class Ground:
    """The rectangle in which there may be cloth: the table, and what hangs beside it rolled out flat.

    Attributes:
        low: smallest x and y, table frame (m).
        high: largest x and y (m).
    """

    low: Point2
    high: Point2

    @staticmethod
    def of(drawing: Drawing) -> "Ground":
        """Return the ground of a drawing."""
        top = TableTop.of(drawing.scene.table)
        corners = np.array([top.low, top.high, *on_table(drawing, ring_of(drawing.outline).points)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        return Ground((float(low[0]), float(low[1])), (float(high[0]), float(high[1])))


def on_table(drawing: Drawing, points: Iterable[Point2]) -> tuple[Point2, ...]:
    """Return points of the garment frame in the table frame (m)."""
    placed = drawing.placement.to_outer(np.array(list(points), dtype=float).reshape(-1, 2))
    return tuple((float(x), float(y)) for x, y in placed)


class Preset(StrEnum):
    """The presets, by the keys of their buttons' labels."""

    FOLLOW = "preset.follow"
    TOP = "preset.top"
    ROBOT = "preset.robot"
    SIDE = "preset.side"
    FREE = "preset.free"


@dataclass(frozen=True, slots=True)
class Lens:
    """A camera's aspect and field of view.

    Attributes:
        aspect: the picture's width divided by its height.
        fov_rad: the vertical field of view (rad).
    """

    aspect: float
    fov_rad: float = FOV_RAD

    def distance(self, half_width_m: float, half_height_m: float) -> float:
        """Return the distance from which given lengths to each side of the middle are in the picture (m)."""
        return max(half_height_m, half_width_m / self.aspect) / math.tan(self.fov_rad / 2.0)


def top(ground: Ground, lens: Lens) -> Viewpoint:
    """Return the view from straight above, as near as the table allows, its far edge at the top or on the right."""
    (x0, y0), (x1, y1) = ground.low, ground.high
    x, y, half_x, half_y = (x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) / 2, (y1 - y0) / 2
    lying, standing = lens.distance(half_x, half_y), lens.distance(half_y, half_x)
    distance = _MARGIN * min(lying, standing)
    dx, dy = (0.0, -_TILT * distance) if lying <= standing else (-_TILT * distance, 0.0)
    return Viewpoint((x + dx, y + dy, distance), (x, y, 0.0))


def side(lens: Lens, table: Table) -> Viewpoint:
    """Return the view from the robot's right, a little above the table, with all of its near edge."""
    x, y, z = _SIDE_CENTRE
    distance = lens.distance(*_SIDE_HALF_M) + table.width_m / 2
    return Viewpoint((x, y - distance, z + _SIDE_RISE * distance), _SIDE_CENTRE)


def robots_eye(
    card: RobotCard, base: Pose2, points: Sequence[Point2], aspect: float, torso_m: float, floor_z_m: float
) -> Viewpoint:
    """Return the view from just before the robot's head, wide enough for all that it looks at.

    Args:
        card: the robot.
        base: where it stands, table frame.
        points: the points it looks at, on the table (m).
        aspect: the picture's width divided by its height.
        torso_m: how far its torso is raised (m).
        floor_z_m: the floor's height in the table frame (m), negative.
    """
    eye = base.to_outer(_eye_in_base(card, torso_m) + np.array([_AHEAD_OF_EYES_M, 0.0, floor_z_m]))
    seen = np.column_stack([np.array(points), np.zeros(len(points))])
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    (x, y, z), (u, v, w) = eye.tolist(), middle.tolist()
    return Viewpoint((x, y, z), (u, v, w), _fov_to_see(seen, eye, middle, aspect))


def _fov_to_see(points: FloatArray, eye: FloatArray, middle: FloatArray, aspect: float) -> float:
    """Return the field of view needed to see points of shape (n, 3) (rad), at least the usual one."""
    ahead = (middle - eye) / np.linalg.norm(middle - eye)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    depth = np.maximum((points - eye) @ ahead, 1e-3)
    across, upwards = (points - middle) @ right / depth, (points - middle) @ np.cross(right, ahead) / depth
    half = _MARGIN * max(np.abs(upwards).max(), np.abs(across).max() / aspect)
    return min(max(2.0 * math.atan(half), FOV_RAD), _WIDEST_RAD)


def _eye_in_base(card: RobotCard, torso_m: float) -> FloatArray:
    """Return where the robot's eyes are while it looks ahead, base frame (m); all links down to them are unturned."""
    if card.eye_frame is None:
        return np.array([0.0, 0.0, _EYES_OVER_FLOOR_M])
    links = load_robot_model(card.urdf_path, card.package_dir)
    eye = next(link for link in links if link.name == card.eye_frame)
    return np.asarray(np.sum([_offset(link, card, torso_m) for link in links if _carries(link, eye)], axis=0))


def _carries(link: Link, other: Link) -> bool:
    return f"{other.node}/".startswith(f"{link.node}/")


def _offset(link: Link, card: RobotCard, torso_m: float) -> FloatArray:
    is_lift = card.lift_joint is not None and link.joint == card.lift_joint
    lift = torso_m * link.axis if is_lift else np.zeros(3)
    return np.array(link.origin.position) + lift
