"""A page of vector drawing, as data and as SVG: shapes in points of 1/72 inch from its upper left corner, y down."""

from dataclasses import dataclass
from typing import Literal, TypeAlias
from xml.sax.saxutils import escape

Spot: TypeAlias = tuple[float, float]
"""A place on the page (pt)."""


@dataclass(frozen=True, slots=True)
class Outline:
    """A line through points, or a filled shape; colours as "rrggbb", empty for none.

    Attributes:
        points: its points.
        fill: the colour of its inside; a shape that is filled is closed.
        stroke: the colour of its line.
        width: the line's width (pt).
    """

    points: tuple[Spot, ...]
    fill: str = ""
    stroke: str = "333333"
    width: float = 0.8


@dataclass(frozen=True, slots=True)
class Disc:
    """A circle, filled and lined.

    Attributes:
        middle: its middle.
        radius: its radius (pt).
        fill: the colour of its inside, as "rrggbb".
        stroke: the colour of its line.
    """

    middle: Spot
    radius: float
    fill: str = "ffffff"
    stroke: str = "333333"


@dataclass(frozen=True, slots=True)
class Words:
    """A line of words.

    Attributes:
        at: where the baseline begins, or has its middle.
        text: the words.
        size: the letters' size (pt).
        is_bold: whether they are bold.
        anchor: whether `at` is the line's start or its middle.
    """

    at: Spot
    text: str
    size: float = 8.0
    is_bold: bool = False
    anchor: Literal["start", "middle"] = "start"


Shape: TypeAlias = Outline | Disc | Words


@dataclass(frozen=True, slots=True)
class Page:
    """A page.

    Attributes:
        width: its width (pt).
        height: its height (pt).
        title: what it is called.
        shapes: what is on it, the lowest first.
    """

    width: float
    height: float
    title: str
    shapes: tuple[Shape, ...]


def page_svg(page: Page) -> bytes:
    """Return the page as an SVG document, as large as it is on paper."""
    size = f'width="{page.width:g}pt" height="{page.height:g}pt" viewBox="0 0 {page.width:g} {page.height:g}"'
    lines = (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="Helvetica, Arial, sans-serif">',
        f"<title>{_text(page.title)}</title>",
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        *map(_element, page.shapes),
        "</svg>",
    )
    return ("\n".join(lines) + "\n").encode("utf-8", "replace")


def _element(shape: Shape) -> str:
    match shape:
        case Outline(points, fill, stroke, width):
            d = "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in points) + ("Z" if fill else "")
            colours = f'fill="{_colour(fill)}" stroke="{_colour(stroke)}"'
            return f'<path d="{d}" {colours} stroke-width="{width:g}" stroke-linejoin="round"/>'
        case Disc((x, y), radius, fill, stroke):
            return (
                f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{radius:g}" fill="{_colour(fill)}" stroke="{_colour(stroke)}"/>'
            )
        case Words((x, y), text, size, is_bold, anchor):
            weight = ' font-weight="bold"' if is_bold else ""
            place = f'x="{x:.2f}" y="{y:.2f}" font-size="{size:g}" text-anchor="{anchor}"'
            return f"<text {place}{weight}>{_text(text)}</text>"


def _colour(colour: str) -> str:
    return f"#{colour}" if colour else "none"


def _text(text: str) -> str:
    return escape("".join(char if char.isprintable() else " " for char in text))
