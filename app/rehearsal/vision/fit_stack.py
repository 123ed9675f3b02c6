"""Fit the outline of a known stack to the points of an outline that a camera saw (paper, section 8).

The distance of every point seen from the stack's outline is made small by least squares. From a wrong angle that ends
in a wrong minimum, so it is begun at angles all round, with a loss that lets far points pull (soft L1); the best few
are fitted again with one that does not (Cauchy): what is far by then is a robot's arm or a wrinkle. Soft L1 alone let
an arm at one end of a tie push it 8 cm along. What else fits about as well is returned too: a rectangle
that is turned by half looks the same.
"""

import numpy as np

from app.rehearsal.vision.stack_figure import POINTS, Figure
from app.rehearsal.vision.stack_fit import StackFit
from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import FloatArray, Pose2


def fit_stack(contour: FloatArray, stack: ClothState, near: Pose2 | None = None) -> StackFit:
    """Return where a stack lies whose outline was seen.

    Args:
        contour: points of the visible outline in the table frame, shape (n, 2), m, at least 8, in any order; points
            that are not of the outline (an arm's edge) do little harm while they are fewer than a third.
        stack: the stack, garment frame.
        near: where it ought to lie; decides between placements that look alike, and is tried first.

    Raises:
        ValueError: there are fewer than 8 points, or one is not finite.
    """
    seen = thinned(contour, POINTS)
    figure = Figure.of(stack)
    return figure.chosen(figure.candidates(seen, near), seen, near)


def fit_near(contour: FloatArray, stack: ClothState, near: Pose2) -> StackFit:
    """Return where a stack lies that is known to lie within some centimetres of a placement; much quicker.

    Takes and raises what `fit_stack` does. Where no placement near to that fits, none is known.
    """
    seen = thinned(contour, POINTS)
    figure = Figure.of(stack)
    return figure.chosen(figure.near_by(seen, near), seen, near)


def thinned(contour: FloatArray, most: int) -> FloatArray:
    """Return at most `most` of the points of an outline, evenly taken; raises `ValueError` for points of no use."""
    points = np.asarray(contour, dtype=np.float64).reshape(-1, 2)
    if len(points) < 8 or not np.isfinite(points).all():
        raise ValueError(f"an outline seen needs 8 finite points or more, there are {len(points)}")
    return points[np.linspace(0, len(points) - 1, min(most, len(points))).round().astype(np.int64)]
