"""The garment file of a drawing, whether it is a good garment or not."""

from typing import Any

from app.drawing.drawing import Drawing
from app.drawing.solve import radius_m


def garment_to_dict(drawing: Drawing) -> dict[str, Any]:
    """The contents of a garment file with the drawing's points; the folds' ends are where they are now."""
    return {
        "name": drawing.name,
        "title": drawing.title,
        "outline": [list(point) for point in drawing.points],
        "areal_density_kg_m2": drawing.areal_density_kg_m2,
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
