"""Makes drawings of garments for robots, whose corners and folds get ids, and garment files of drawings."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from app.drawing.drawing import Corner, Crease, Drawing, End
from app.drawing.ring import ring_of
from app.drawing.solution import Solution
from app.drawing.solve import radius_m
from planner.cloth.garment import DEFAULT_DENSITY_KG_M2, DEFAULT_GRIP_RADIUS_M, Garment, centred_placement
from planner.geometry.pose import Pose2
from planner.planning.robot_task import default_placement, default_scene, near_placement
from planner.robots.load_robot import robot_card_file
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT

START_STATION = "front"

COMFORT_RADIUS_M = 0.03
"""Default comfort radius (m)."""


def drawing_of(garment: Garment, scene: Scene | None = None, robot: str = DEFAULT_ROBOT) -> Drawing:
    """Return a garment as a drawing for a robot, placed where it suits; the scene is the robot's own by default."""
    where = scene or default_scene(robot)
    stations = [name for name, _ in where.stations]
    return Drawing(
        garment.name,
        garment.title,
        tuple(Corner(f"v{i}", point) for i, point in enumerate(garment.outline)),
        garment.areal_density_kg_m2,
        garment.grip_radius_m,
        tuple(
            Crease(
                f"f{i}",
                fold.name,
                fold.kind,
                End(fold.start),
                End(fold.end),
                None if fold.grip_radius_m == garment.grip_radius_m else fold.grip_radius_m,
            )
            for i, fold in enumerate(garment.folds)
        ),
        default_placement(garment, robot),
        where,
        START_STATION if START_STATION in stations else stations[0],
        COMFORT_RADIUS_M,
        robot,
        garment.thickness_m,
    )


def blank_drawing() -> Drawing:
    """Return a drawing without outline or folds, with the garment frame's origin in the middle of the table."""
    return Drawing(
        name="untitled",
        title="Untitled",
        outline=(),
        areal_density_kg_m2=DEFAULT_DENSITY_KG_M2,
        grip_radius_m=DEFAULT_GRIP_RADIUS_M,
        folds=(),
        placement=centred_placement(((0.0, 0.0),)),
        scene=Scene(),
        start_station=START_STATION,
        comfort_radius_m=COMFORT_RADIUS_M,
    )


def garment_to_dict(drawing: Drawing) -> dict[str, Any]:
    """Return a drawing, valid or not, as a garment file, with curves as points and folds' ends at their positions."""
    return {
        "name": drawing.name,
        "title": drawing.title,
        "outline": [list(point) for point in ring_of(drawing.outline).points],
        "areal_density_kg_m2": drawing.areal_density_kg_m2,
        "thickness_m": drawing.thickness_m,
        "folds": [
            {
                "name": fold.name,
                "kind": fold.kind,
                "start": list(fold.start.point),
                "end": list(fold.end.point),
                "grip_radius_m": radius_m(drawing, fold),
            }
            for fold in drawing.folds
        ],
        "grip_radius_m": drawing.grip_radius_m,
        "placement": drawing.placement.to_dict(),
    }


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
