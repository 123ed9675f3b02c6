"""An empty drawing, for a new document."""

from app.drawing.drawing import Drawing
from app.drawing.garment_drawing import COMFORT_RADIUS_M, START_STATION
from planner.cloth.garment import DEFAULT_DENSITY_KG_M2, DEFAULT_GRIP_RADIUS_M, centred_placement
from planner.task.scene import Scene


def blank_drawing() -> Drawing:
    """Return a drawing without outline or folds, with the article frame's origin in the middle of the table."""
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
