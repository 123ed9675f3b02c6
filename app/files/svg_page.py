"""Tells the page of an SVG drawing, and a frame drawn a little inside of its edges, from a garment."""

from collections.abc import Sequence

import numpy as np

from planner.geometry.arrangement import are_tangled, enclosing_rings, signed_area
from planner.geometry.pose import FloatArray

_SLACK = 0.005
"""By how much the page may differ from the sheet, and a frame's distances from each other, as a share of the sheet."""

_MARGIN_MAX = 0.1
"""The largest distance of a frame from the edges of the sheet, as a share of its shorter side."""

_GARMENT_SHARES = (0.05, 0.8)
"""The least and the largest share of a page that a garment on it covers: what is smaller is a detail of what fills the
page, what is larger its seam line."""

_LEGEND = 0.25
"""Fold lines beside a garment that are no longer than this share of a frame's shorter side explain the drawing."""

_OUTLINED = 0.9
"""The least share of the box about open lines that the closed lines which they make cover, unless they are a grid."""

_OPEN_MAX, _CROSSINGS_MAX = 500, 2_000
"""Largest numbers of open lines, and of their crossings, that a garment in a frame is looked for in."""

_SAMPLES = np.linspace(0.0, 1.0, 21)


def box_of(points: FloatArray) -> FloatArray:
    """Return the lowest and the highest coordinates of points, shape (2, 2)."""
    return np.array([points.min(axis=0), points.max(axis=0)])


def may_be_garment(area: float, page: FloatArray) -> bool:
    """Return whether an area is as large as a garment on a page may be, given the page's box, shape (2, 2)."""
    least, most = _GARMENT_SHARES
    return area > 0.0 and least * _area_of(page) <= area <= most * _area_of(page)


def is_page(box: FloatArray, area: float, sheet: FloatArray) -> bool:
    """Return whether a closed line is a rectangle that covers the sheet.

    Args:
        box: its lowest and highest coordinates, shape (2, 2).
        area: the area in it.
        sheet: the lowest and highest coordinates of the sheet, shape (2, 2).
    """
    slack = _SLACK * np.ptp(sheet, axis=0)
    is_wide = bool(np.all(box[0] <= sheet[0] + slack) and np.all(box[1] >= sheet[1] - slack))
    return is_wide and _is_rectangle(box, area)


def is_frame(box: FloatArray, area: float, sheet: FloatArray) -> bool:
    """Return whether a closed line is a rectangle a little inside of the sheet, as far from each of its edges.

    Args:
        box: its lowest and highest coordinates, shape (2, 2).
        area: the area in it.
        sheet: the lowest and highest coordinates of the sheet, shape (2, 2).
    """
    sides = np.ptp(sheet, axis=0)
    margins = np.concatenate([box[0] - sheet[0], sheet[1] - box[1]])
    is_near = bool(margins.min() >= 0.0 and margins.max() <= _MARGIN_MAX * sides.min())
    return is_near and bool(np.ptp(margins) <= _SLACK * sides.max()) and _is_rectangle(box, area)


def is_frame_around(
    frame: FloatArray,
    areas: Sequence[tuple[FloatArray, float]],
    lines: Sequence[FloatArray],
    folds: Sequence[FloatArray],
    gap: float,
) -> bool:
    """Return whether a rectangle is only the frame around a garment: that is in it, and no fold is the rectangle's own.

    Args:
        frame: the lowest and highest coordinates of the rectangle, shape (2, 2).
        areas: the boxes of the closed lines, and the areas in them.
        lines: the open lines, each shape (n, 2).
        folds: the ends of each fold line, shape (2, 2).
        gap: the largest gap between open lines that make a closed one.
    """
    largest = max((area for _, area in (*areas, *_drawn_open(frame, areas, lines, gap))), default=0.0)
    if not may_be_garment(largest, frame):
        return False
    boxes = [*(box for box, _ in areas), *map(box_of, lines)]
    slack = _SLACK * float(np.ptp(frame, axis=0).max())
    if not all(np.all(box[0] >= frame[0] - slack) and np.all(box[1] <= frame[1] + slack) for box in boxes):
        return False
    inner = box_of(np.concatenate(boxes))
    short = _LEGEND * float(np.ptp(frame, axis=0).min())
    return all(
        not _touches(ends, frame, slack) and (_is_within(ends, inner) or float(np.hypot(*(ends[1] - ends[0]))) <= short)
        for ends in folds
    )


def _drawn_open(
    frame: FloatArray, areas: Sequence[tuple[FloatArray, float]], lines: Sequence[FloatArray], gap: float
) -> list[tuple[FloatArray, float]]:
    """Return the boxes and areas of what open lines outside of closed ones make together; none for a grid of them."""
    free = [line for line in lines if len(line) > 1 and not any(_holds(box, box_of(line)) for box, _ in areas)]
    if not free or not all(_holds(frame, box_of(line)) for line in free):
        return []
    size = float(np.ptp(frame, axis=0).max())
    free = [(line - frame[0]) / size for line in free]  # rings are found to a precision in metres: 1 is a usual size
    if len(free) > _OPEN_MAX or are_tangled(free, _CROSSINGS_MAX):
        return []
    found = [(box_of(ring), abs(float(signed_area(ring)))) for ring in enclosing_rings(free, gap / size)]
    if not found:
        return []
    around = box_of(np.concatenate([box for box, _ in found]))
    if _area_of(around) < _OUTLINED * _area_of(box_of(np.concatenate(free))):
        return []
    return [(size * box + frame[0], size * size * area) for box, area in found]


def _holds(box: FloatArray, other: FloatArray) -> bool:
    return bool(np.all(other[0] >= box[0]) and np.all(other[1] <= box[1]))


def _is_rectangle(box: FloatArray, area: float) -> bool:
    return area >= (1.0 - _SLACK) * _area_of(box)


def _area_of(box: FloatArray) -> float:
    width, height = np.ptp(box, axis=0).tolist()
    return float(width * height)


def _is_within(ends: FloatArray, box: FloatArray) -> bool:
    """Return whether at least half of a line is in a box."""
    points = ends[0] + _SAMPLES[:, None] * (ends[1] - ends[0])
    return bool(np.mean(np.all((points >= box[0]) & (points <= box[1]), axis=1)) >= 0.5)


def _touches(ends: FloatArray, frame: FloatArray, slack: float) -> bool:
    """Return whether a line ends on a rectangle's edge, or leaves it."""
    return not bool(np.all((ends >= frame[0] + slack) & (ends <= frame[1] - slack)))
