"""Small charts with logarithmic axes, as text: rows and columns of panels on one sheet of SVG."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from docs.figures.drawing import FAINT, PAPER, Drawing, Style, View
from planner.geometry.pose import Point2

_WIDTH_PX, _HEIGHT_PX = 300.0, 236.0
"""Size of a panel with its labels."""

_LEFT_PX, _RIGHT_PX, _ABOVE_PX, _BELOW_PX = 52.0, 16.0, 14.0, 40.0
"""Margins of a panel for its labels."""

_HEAD_PX, _ENTRY_PX, _FOOT_PX = 14.0, 17.0, 26.0
_ROOM = 1.25
"""Factor by which axes extend beyond the data."""

_COLOURS = ("#2f6fb3", "#c4572e", "#4d8b4a", "#7a5aa6")
_GRID = Style("#dcd9d2", width=1.0)
_SIZE = 11.0
_APART_PX = 13.0
"""Least distance between neighbouring labels below an axis."""


@dataclass(frozen=True, slots=True)
class Point:
    """A point of a line; drawn hollow where its value is not final because the time ran out."""

    x: float
    y: float
    is_full: bool = True


@dataclass(frozen=True, slots=True)
class Series:
    """A named line through points."""

    name: str
    points: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Panel:
    """A chart: its axis labels, units included, and its lines."""

    x_label: str
    y_label: str
    series: tuple[Series, ...]


@dataclass(frozen=True, slots=True)
class _Axis:
    """A logarithmic axis from a least to a largest value, with its length in pixels."""

    least: float
    most: float
    length_px: float

    def at(self, value: float) -> float:
        return self.length_px * math.log(value / self.least) / math.log(self.most / self.least)


def draw(rows: Sequence[Sequence[Panel]]) -> str:
    """Return the panels as SVG; panels in a column have the same lines, which one legend above them names."""
    entries = max(len(panel.series) for panel in rows[0])
    head = _HEAD_PX + _ENTRY_PX * entries
    width, height = _WIDTH_PX * len(rows[0]), head + _HEIGHT_PX * len(rows) + _FOOT_PX
    sheet = Drawing(round(width), round(height), "How search time and expansions grow with the size of the problem")
    for column, panel in enumerate(rows[0]):
        _legend(sheet, (column * _WIDTH_PX + _LEFT_PX, _HEAD_PX), panel)
    for row, panels in enumerate(rows):
        for column, panel in enumerate(panels):
            _draw_panel(sheet, (column * _WIDTH_PX, head + row * _HEIGHT_PX), panel)
    sheet.text((_LEFT_PX, height - 10), "hollow: the time ran out before there was an answer", size=_SIZE, fill=FAINT)
    return sheet.to_svg()


def _legend(sheet: Drawing, place: Point2, panel: Panel) -> None:
    for number, series in enumerate(panel.series):
        y = place[1] + _ENTRY_PX * (number + 0.5)
        key = sheet.view((place[0], y), 1.0)
        key.line("key", ((0.0, 0.0), (18.0, 0.0)), Style(_COLOURS[number], width=2.0))
        sheet.text((place[0] + 24, y + 4), series.name, size=_SIZE + 1)


def _draw_panel(sheet: Drawing, corner: Point2, panel: Panel) -> None:
    across, up = _WIDTH_PX - _LEFT_PX - _RIGHT_PX, _HEIGHT_PX - _ABOVE_PX - _BELOW_PX
    points = [point for series in panel.series for point in series.points]
    x_axis = _axis([point.x for point in points], across)
    y_axis = _axis([point.y for point in points], up)
    view = sheet.view((corner[0] + _LEFT_PX, corner[1] + _ABOVE_PX + up), 1.0)
    written = -_APART_PX
    for value in sorted({point.x for point in points}):
        x = x_axis.at(value)
        view.line("grid", ((x, 0.0), (x, up)), _GRID)
        if x - written >= _APART_PX:
            view.text((x, 0.0), f"{value:g}", shift=(0.0, 15.0), size=_SIZE, anchor="middle", fill=FAINT)
            written = x
    for value in _decades(y_axis):
        view.text((0.0, y_axis.at(value)), f"{value:g}", shift=(-6.0, 4.0), size=_SIZE, anchor="end", fill=FAINT)
        view.line("grid", ((0.0, y_axis.at(value)), (across, y_axis.at(value))), _GRID)
    view.line("axes", ((0.0, up), (0.0, 0.0), (across, 0.0)), Style(FAINT, width=1.0))
    view.text((across / 2, 0.0), panel.x_label, shift=(0.0, 32.0), size=_SIZE + 1, anchor="middle")
    view.text((0.0, up), panel.y_label, shift=(-_LEFT_PX + 8.0, -3.0), size=_SIZE + 1)
    for number, series in enumerate(panel.series):
        _draw_series(view, series, _COLOURS[number], x_axis, y_axis)


def _draw_series(view: View, series: Series, colour: str, x_axis: _Axis, y_axis: _Axis) -> None:
    places = [(x_axis.at(point.x), y_axis.at(point.y)) for point in series.points]
    view.line("series", places, Style(colour, width=1.8))
    for point, place in zip(series.points, places, strict=True):
        kind, fill = ("point", colour) if point.is_full else ("point hollow", PAPER)
        view.dot(kind, place, 3.0, Style(colour, fill))


def _axis(values: Sequence[float], length_px: float) -> _Axis:
    return _Axis(min(values) / _ROOM, max(values) * _ROOM, length_px)


def _decades(axis: _Axis) -> list[float]:
    """Return the powers of ten on an axis, and between them 2 and 5 if there are too few."""
    first, last = math.floor(math.log10(axis.least)), math.ceil(math.log10(axis.most))
    tens = [10.0**power for power in range(first, last + 1)]
    found = [ten for ten in tens if axis.least <= ten <= axis.most]
    if len(found) < 3:
        found = [ten * step for ten in tens for step in (1, 2, 5) if axis.least <= ten * step <= axis.most]
    return found
