"""Gives a drawing another robot, with the scene, the start and the placement that suit it."""

from collections.abc import Iterable
from dataclasses import replace

from app.drawing.drawing import Drawing
from app.drawing.solution import Solution
from planner.cloth.garment import Garment, centred_placement
from planner.geometry.pose import Pose2
from planner.planning.robot_task import default_placement, default_scene, near_placement
from planner.robots.load_robot import robot_card_file
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT


def with_robot(solution: Solution, robot: str, past: Iterable[Drawing] = ()) -> Drawing:
    """Return a solved drawing for another robot: its scene, its first station, and where the garment lies for it.

    Where the robot folded the same outline before, all that is as it was then.

    Args:
        solution: the drawing.
        robot: the robot's name.
        past: earlier drawings, the latest first.

    Raises:
        RequestError: there is no such robot.
    """
    drawing = solution.drawing
    for known in past:
        if known.robot == robot and known.outline == drawing.outline:
            return replace(
                drawing, robot=robot, scene=known.scene, start_station=known.start_station, placement=known.placement
            )
    scene = default_scene(robot)
    return replace(
        drawing,
        robot=robot,
        scene=scene,
        start_station=scene.stations[0][0],
        placement=_placement(drawing, solution.spread, scene, robot),
    )


def _placement(drawing: Drawing, garment: Garment | None, scene: Scene, robot: str) -> Pose2:
    """Return the garment's placement for a robot, table frame, with its present yaw if that fits.

    Garments have a placement of their own for the default robot only. One that lies elsewhere is laid with its near
    edge just inside the table's, where that robot's arms reach best.
    """
    if garment is None:
        suits = robot_card_file(robot).scene.placement
        return centred_placement(((0.0, 0.0),)) if robot == DEFAULT_ROBOT else suits
    if robot != DEFAULT_ROBOT:
        return default_placement(garment, robot)
    return near_placement(garment, scene.table, drawing.placement.yaw_rad)
