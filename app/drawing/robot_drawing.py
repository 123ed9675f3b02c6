"""Gives a drawing another robot, with the scene, the start and the placement that suit it."""

from dataclasses import replace

import numpy as np

from app.drawing.drawing import Drawing
from app.drawing.solution import Solution
from planner.cloth.garment import Garment, centred_placement
from planner.geometry.pose import Pose2
from planner.planning.robot_task import default_placement, default_scene
from planner.robots.load_robot import robot_card_file
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT

INSIDE_M = 0.05
"""The distance of the cloth from the table's near edge for the default robot (m)."""


def with_robot(solution: Solution, robot: str) -> Drawing:
    """Return a solved drawing for another robot: its scene, its first station, and where the article lies for it.

    Raises:
        RequestError: there is no such robot.
    """
    drawing, scene = solution.drawing, default_scene(robot)
    return replace(
        drawing,
        robot=robot,
        scene=scene,
        start_station=scene.stations[0][0],
        placement=_placement(drawing, solution.spread, scene, robot),
    )


def _placement(drawing: Drawing, garment: Garment | None, scene: Scene, robot: str) -> Pose2:
    """Return where the article lies for a robot, table frame, turned as it is now where that fits.

    Garments have a placement of their own for the default robot only. One that lies elsewhere is laid with its near
    edge just inside the table's, where that robot's arms reach best.
    """
    if garment is None:
        suits = robot_card_file(robot).scene.placement
        return centred_placement(((0.0, 0.0),)) if robot == DEFAULT_ROBOT else suits
    if robot != DEFAULT_ROBOT:
        return default_placement(garment, robot)
    turned = Pose2(0.0, 0.0, drawing.placement.yaw_rad)
    corners = turned.to_outer(np.array(garment.outline))
    (x0, y0), (_, y1) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return turned.moved(INSIDE_M - scene.table.depth_m / 2 - x0, -(y0 + y1) / 2)
