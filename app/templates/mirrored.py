"""Completes garments whose right half mirrors the left."""

from planner.cloth.garment import DrawnFold
from planner.geometry.pose import Point2


def both_halves(left: tuple[Point2, ...], width_m: float) -> tuple[Point2, ...]:
    """Return the outline through the points of the left half, then their mirror images in reverse order."""
    return (*left, *(_image(point, width_m) for point in reversed(left)))


def both_folds(left: tuple[DrawnFold, ...], width_m: float) -> tuple[DrawnFold, ...]:
    """Return the folds on the left, then their mirror images, with "left" in their names replaced by "right"."""
    images = (
        DrawnFold(
            fold.name.replace("left", "right"),
            fold.kind,
            _image(fold.end, width_m),
            _image(fold.start, width_m),
            fold.grip_radius_m,
        )
        for fold in left
    )
    return (*left, *images)


def _image(point: Point2, width_m: float) -> Point2:
    return (width_m - point[0], point[1])
