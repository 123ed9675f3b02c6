"""The opening viewpoint: as near as possible with all of the table and the robot in the picture.

A wide picture shows the table from its side. A tall picture would show it small that way, so the narrower the picture,
the more the camera turns to look along the table at the robot. Arms that are bolted to a bench are shown with its top
alone, as large as they can be. Table frame, z up.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from app.ui.robot_model import waiting_box
from app.ui.viewpoint import FOV_RAD, Viewpoint
from planner.geometry.pose import FloatArray, Point3, Pose2
from planner.robots.card import RobotCard
from planner.task.scene import Scene

_LOOK_AT: Point3 = (-0.34, -0.06, -0.21)
_RISE_RAD = math.radians(35.5)
_WIDE, _ACROSS_RAD = 1.0, math.radians(54.35)
_TALL, _ALONG_RAD = 0.5, math.radians(10.0)
_NARROWEST = 0.2
_NEAREST_M = 3.687
_MARGIN = 1.02
_TRUNK_M = (((-0.34, 0.34), (-0.34, 0.34), (0.0,)), ((-0.1, 0.1), (0.0,), (1.65,)))
"""Boxes of base and head: ranges of x, y and height over the floor, base frame (m)."""
_ARMS_M = (((-0.1, 0.39), (-0.64, 0.64), (0.8, 1.4)),)
"""Box of the arms at home; after driving back the robot has them in front, over the table."""


def opening(scene: Scene, aspect: float, base: Pose2 | None = None, *, card: RobotCard | None = None) -> Viewpoint:
    """Return a viewpoint that shows the table and the robot whole, also while the robot stands back from the table.

    Args:
        scene: table and stations.
        aspect: the picture's width divided by its height; a picture narrower than a fifth of its height is not filled.
        base: where the robot stands, table frame; None: at the first station.
        card: the robot; None for one that drives.
    """
    aspect = max(aspect, _NARROWEST)
    share = min(max((aspect - _TALL) / (_WIDE - _TALL), 0.0), 1.0)
    yaw_rad = _ALONG_RAD + share * (_ACROSS_RAD - _ALONG_RAD)
    level = math.cos(_RISE_RAD)
    back = np.array([level * math.cos(yaw_rad), level * math.sin(yaw_rad), math.sin(_RISE_RAD)])
    stands = base or scene.stations[0][1]
    if card is not None and card.is_fixed:
        return _at_bench(bench(scene, stands, card), back, aspect)
    look_at = np.array(_LOOK_AT)
    away_m = _distance(whole(scene, stands) - look_at, back, aspect)
    x, y, z = (look_at + max(_NEAREST_M, _MARGIN * away_m) * back).tolist()
    return Viewpoint((x, y, z), _LOOK_AT)


def _at_bench(points: FloatArray, back: FloatArray, aspect: float) -> Viewpoint:
    """Return the viewpoint in a direction from the middle of points from which all of them are seen."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    x, y, z = (middle + _MARGIN * _distance(points - middle, back, aspect) * back).tolist()
    u, v, w = middle.tolist()
    return Viewpoint((x, y, z), (u, v, w))


def bench(scene: Scene, base: Pose2, card: RobotCard) -> FloatArray:
    """Return the corners of the table's top and of the box around a robot that waits there, shape (n, 3), m."""
    box = waiting_box(card, scene.torso_m) - np.array([0.0, 0.0, scene.table.height_m])
    table = [(x, y, 0.0) for x, y in scene.table.corners]
    return np.concatenate([np.array(table), base.to_outer(np.array(list(itertools.product(*box.T))))])


def whole(scene: Scene, base: Pose2) -> FloatArray:
    """Return the corners of the table and of the robot, at its base and at its furthest standoff, shape (n, 3), m."""
    floor_z_m = -scene.table.height_m
    table = [(x, y, z) for x, y in scene.table.corners for z in (0.0, floor_z_m)]
    trunk, arms = _corners(_TRUNK_M, floor_z_m), _corners(_ARMS_M, floor_z_m)
    backed_off = base.ahead(-scene.back_off_max_m)
    return np.concatenate([np.array(table), base.to_outer(trunk), base.to_outer(arms), backed_off.to_outer(trunk)])


def _corners(boxes: Sequence[Sequence[Sequence[float]]], floor_z_m: float) -> FloatArray:
    points = [point for box in boxes for point in itertools.product(*box)]
    return np.asarray(np.array(points) + np.array([0.0, 0.0, floor_z_m]))


def _distance(points: FloatArray, back: FloatArray, aspect: float) -> float:
    """Return the distance (m) in a direction from which all points are in the picture centred on the origin."""
    right = np.cross((0.0, 0.0, 1.0), back)
    right /= np.linalg.norm(right)
    up, high = np.cross(back, right), math.tan(FOV_RAD / 2.0)
    needed = np.maximum(np.abs(points @ up) / high, np.abs(points @ right) / (aspect * high))
    return float(np.max(points @ back + needed))
