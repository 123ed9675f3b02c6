"""A page of vector drawing, as data: shapes in points of 1/72 inch from its upper left corner, y down."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

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
