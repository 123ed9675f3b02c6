"""The first drawing of a document: of a garment, whose corners and folds get ids, or an empty one."""

from app.drawing.drawing import Corner, Crease, Drawing, End
from planner.cloth.garment import DEFAULT_DENSITY_KG_M2, DEFAULT_GRIP_RADIUS_M, Garment, centred_placement
from planner.planning.robot_task import default_placement, default_scene
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
