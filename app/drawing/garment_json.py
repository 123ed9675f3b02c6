"""Writes a drawing as a garment file, even if it is not a valid garment."""

from typing import Any

from app.drawing.drawing import Drawing
from app.drawing.ring import ring_of
from app.drawing.solve import radius_m


def garment_to_dict(drawing: Drawing) -> dict[str, Any]:
    """Return the contents of a garment file, with curves as points and the folds' ends at their positions."""
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
