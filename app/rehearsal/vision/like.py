"""Fit a known kind of garment to an outline seen: its measures, or its width and height, and where it lies."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from scipy.optimize import least_squares

from app.rehearsal.vision.fit_stack import thinned
from app.rehearsal.vision.outline_edges import OutlineEdges
from app.rehearsal.vision.stack_figure import POINTS, Figure
from app.rehearsal.vision.vision_errors import NothingToldError
from app.templates.template import Template
from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import Garment
from planner.errors import FieldError
from planner.geometry.pose import FloatArray, Point2, Pose2
from planner.geometry.region import Region
from planner.message import Message

Like: TypeAlias = Template | Garment

_TRIED, _STEPS, _SOFT_M = 2, 25, 0.008
_STIFF_M = 0.02
"""The distance of a point of the outline that costs as much as a measure e times as large as the others (m)."""

_IMPOSSIBLE_M = 0.5


@dataclass(frozen=True, slots=True)
class Likened:
    """A known garment fitted to an outline.

    Attributes:
        garment: the garment, its folds with it.
        placement: its garment frame in the frame of the outline.
        distances: how far the outline's points are outside its own (m).
    """

    garment: Garment
    placement: Pose2
    distances: FloatArray


def liken(contour: FloatArray, like: Like) -> Likened:
    """Return a template with other measures, or a garment made wider and longer, that fits an outline best.

    Args:
        contour: points of the outline, shape (n, 2), m.
        like: what it is like.

    Raises:
        NothingToldError: nothing of that kind fits.
    """
    seen = thinned(contour, POINTS)
    size = math.sqrt(Region.polygon(contour).area)
    made, count = _maker(like)
    usual = made(np.zeros(count))
    start = np.full(count, math.log(size / math.sqrt(usual.pattern.area)))
    try:
        figure = Figure.of(ClothState.spread_out(made(start).pattern))
    except FieldError:
        raise _nothing_fits() from None
    fits = [
        _fitted(made, np.concatenate([one.row, start]), seen, figure) for one in figure.candidates(seen, None)[:_TRIED]
    ]
    return min(fits, key=lambda fit: float(np.minimum(np.abs(fit.distances), _SOFT_M * 4).mean()))


def _fitted(made: Callable[[FloatArray], Garment], start: FloatArray, seen: FloatArray, figure: Figure) -> Likened:
    """Return what the least squares reach from a placement and measures."""

    def off(row: FloatArray) -> FloatArray:
        sizes = row[3:]
        stiff = _STIFF_M * (sizes - sizes.mean())
        try:
            edges = OutlineEdges.of(made(sizes).pattern)
        except FieldError:
            return np.concatenate([np.full(len(seen), _IMPOSSIBLE_M), stiff])
        return np.concatenate([edges.distances(figure.pose(row).to_inner(seen))[0], stiff])

    found = least_squares(off, start, loss="soft_l1", f_scale=_SOFT_M, diff_step=1e-4, max_nfev=_STEPS)
    row = np.asarray(found.x)
    try:
        garment = made(row[3:])
    except FieldError:
        raise _nothing_fits() from None
    return Likened(garment, figure.pose(row), off(row)[: len(seen)])


def _maker(like: Like) -> tuple[Callable[[FloatArray], Garment], int]:
    """Return what makes a garment of the logarithms of its sizes, as shares of the usual ones, and how many these are.

    It raises `FieldError` where no garment has such sizes.
    """
    if isinstance(like, Garment):
        return lambda sizes: _stretched(like, math.exp(sizes[0]), math.exp(sizes[1])), 2
    measures = like.measures

    def made(sizes: FloatArray) -> Garment:
        return like.garment({one.name: one.default_m * math.exp(s) for one, s in zip(measures, sizes, strict=True)})

    return made, len(measures)


def _stretched(garment: Garment, wider: float, longer: float) -> Garment:
    """Return a garment with its outline and folds made wider and longer."""

    def at(point: Point2) -> Point2:
        return (point[0] * wider, point[1] * longer)

    folds = tuple(replace(fold, start=at(fold.start), end=at(fold.end)) for fold in garment.folds)
    return replace(garment, outline=tuple(at(point) for point in garment.outline), folds=folds)


def _nothing_fits() -> NothingToldError:
    return NothingToldError(Message.plain("no garment of that kind has an outline like the one seen"))
