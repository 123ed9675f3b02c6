"""Line drawings in SVG: a sheet in pixels, and views on it that are drawn in metres.

Every mark has a class that says what it is, so that a drawing can be asked what it shows. Lengths are rounded to a
tenth of a pixel: the same drawing comes out on every machine.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass

from app.ui.colours import LIGHT, Rgb
from planner.geometry.pose import Point2

PAPER = "#fbfaf7"
INK = "#202226"
FAINT = "#8a8f98"
TABLE = "#d9cfc2"
NONE = "none"


def colour(rgb: Rgb) -> str:
    """A colour of the 3D view as SVG writes it."""
    return "#{:02x}{:02x}{:02x}".format(*rgb)


FRONT, BACK = colour(LIGHT.cloth_front), colour(LIGHT.cloth_back)
EDGE = colour(LIGHT.cloth_edge)
BLUE, RED = colour(LIGHT.folds["blue"]), colour(LIGHT.folds["red"])

_FONT = "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif"


@dataclass(frozen=True, slots=True)
class Style:
    """How a line or an area looks.

    Attributes:
        stroke: the line's colour.
        fill: the area's colour.
        width: the line's width (px).
        dash: lengths of dashes and gaps (px), as SVG writes them; empty for a solid line.
        opacity: of the area, 0..1.
    """

    stroke: str = INK
    fill: str = NONE
    width: float = 1.5
    dash: str = ""
    opacity: float = 1.0

    def attributes(self) -> dict[str, str]:
        """The attributes of an SVG element."""
        found = {"stroke": self.stroke, "fill": self.fill, "stroke-width": f"{self.width:g}"}
        if self.dash:
            found["stroke-dasharray"] = self.dash
        if self.opacity < 1.0:
            found["fill-opacity"] = f"{self.opacity:g}"
        return found


class Drawing:
    """A sheet of paper, its origin at the upper left, y down (px)."""

    def __init__(self, width: int, height: int, title: str) -> None:
        """An empty sheet with a title for those who cannot see it."""
        size = {"width": str(width), "height": str(height), "viewBox": f"0 0 {width} {height}"}
        self._root = ET.Element("svg", {"xmlns": "http://www.w3.org/2000/svg", "role": "img", **size})
        ET.SubElement(self._root, "title").text = title
        self._arrow_heads: set[str] = set()
        ET.SubElement(self._root, "rect", {"width": str(width), "height": str(height), "fill": PAPER})

    def view(self, origin: Point2, scale: float, middle: Point2 = (0.0, 0.0)) -> "View":
        """A view in metres, y up: the place `middle` of it is at `origin` on the sheet; `scale` is in px/m."""
        return View(self, origin, scale, middle)

    def add(self, tag: str, kind: str, attributes: dict[str, str]) -> ET.Element:
        """Add an element of a class."""
        return ET.SubElement(self._root, tag, {"class": kind, **attributes})

    def text(
        self, place: Point2, words: str, *, size: float = 13, anchor: str = "start", fill: str = INK, bold: bool = False
    ) -> None:
        """Write at a place of the sheet (px)."""
        font = {"font-family": _FONT, "font-size": f"{size:g}", "text-anchor": anchor, "fill": fill}
        weight = {"font-weight": "600"} if bold else {}
        self.add("text", "words", {"x": _px(place[0]), "y": _px(place[1]), **font, **weight}).text = words

    def arrow_head(self, fill: str) -> str:
        """The name of an arrow head of a colour, for `marker-end`."""
        name = f"arrow-{fill.lstrip('#')}"
        if name not in self._arrow_heads:
            self._arrow_heads.add(name)
            box = {"viewBox": "0 0 10 10", "refX": "9", "refY": "5", "markerWidth": "7", "markerHeight": "7"}
            marker = ET.SubElement(self._root, "marker", {"id": name, "orient": "auto-start-reverse", **box})
            ET.SubElement(marker, "path", {"d": "M0 0L10 5L0 10z", "fill": fill})
        return f"url(#{name})"

    def to_svg(self) -> str:
        """The drawing as the text of a file."""
        ET.indent(self._root)
        return ET.tostring(self._root, encoding="unicode") + "\n"


@dataclass(frozen=True, slots=True)
class View:
    """A part of a sheet that is drawn in metres, y up.

    Attributes:
        sheet: the drawing.
        origin: where the view's middle is on the sheet (px).
        scale: px/m.
        middle: the place shown there (m).
    """

    sheet: Drawing
    origin: Point2
    scale: float
    middle: Point2 = (0.0, 0.0)

    def at(self, place: Point2) -> Point2:
        """Where a place is on the sheet (px)."""
        x, y = float(place[0]) - self.middle[0], float(place[1]) - self.middle[1]
        return (self.origin[0] + self.scale * x, self.origin[1] - self.scale * y)

    def polygon(self, kind: str, ring: Iterable[Point2], style: Style) -> None:
        """A closed area."""
        self.sheet.add(
            "polygon", kind, {"points": self._points(ring), "stroke-linejoin": "round", **style.attributes()}
        )

    def line(self, kind: str, points: Iterable[Point2], style: Style, *, arrow: bool = False) -> None:
        """A line through points, with a head at its end if it is an arrow."""
        head = {"marker-end": self.sheet.arrow_head(style.stroke)} if arrow else {}
        ends = {"stroke-linecap": "round", "stroke-linejoin": "round"}
        self.sheet.add("polyline", kind, {"points": self._points(points), **ends, **style.attributes(), **head})

    def dot(self, kind: str, place: Point2, radius_px: float, style: Style) -> None:
        """A mark of a size that does not depend on the scale."""
        x, y = self.at(place)
        self.sheet.add("circle", kind, {"cx": _px(x), "cy": _px(y), "r": f"{radius_px:g}", **style.attributes()})

    def circle(self, kind: str, place: Point2, radius_m: float, style: Style) -> None:
        """A circle."""
        self.dot(kind, place, round(radius_m * self.scale, 1), style)

    def text(
        self, place: Point2, words: str, *, shift: Point2 = (0.0, 0.0), size: float = 13, anchor: str = "start",
        fill: str = INK, bold: bool = False,
    ) -> None:  # fmt: skip
        """Write at a place, shifted by so much on the sheet (px)."""
        x, y = self.at(place)
        self.sheet.text((x + shift[0], y + shift[1]), words, size=size, anchor=anchor, fill=fill, bold=bold)

    def _points(self, places: Iterable[Point2]) -> str:
        return " ".join(f"{_px(x)},{_px(y)}" for x, y in map(self.at, places))


def _px(value: float) -> str:
    return f"{round(value, 1) + 0.0:g}"
