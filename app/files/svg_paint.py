"""Whether an SVG shape can be seen: its edge, its area, or nothing of it."""

import re
from collections.abc import Mapping

from app.files.colour_spaces import Rgb
from app.files.fold_colour import alpha_of, css_rgb

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)", re.IGNORECASE)

_LONGEST = 100
"""Longest text that is looked at as a paint or a number (characters)."""

WHITE_MIN = 0.9
"""The least of red, green and blue of what counts as white paper."""


def is_hidden(style: Mapping[str, str]) -> bool:
    """Return whether nothing of an element and its content is displayed."""
    return style.get("display") == "none" or _is_zero(style.get("opacity"))


def is_invisible(style: Mapping[str, str]) -> bool:
    """Return whether an element is invisible; its content may be visible."""
    return style.get("visibility") in ("hidden", "collapse")


def is_stroked(style: Mapping[str, str]) -> bool:
    """Return whether a line is drawn along a shape's edge."""
    is_thick = not _is_zero(style.get("stroke-width")) and not _is_zero(style.get("stroke-opacity"))
    return is_thick and _is_paint(style.get("stroke", "none"), style)


def is_filled(style: Mapping[str, str]) -> bool:
    """Return whether a shape's area is painted, which it is in black if the file says nothing."""
    return not _is_zero(style.get("fill-opacity")) and _is_paint(style.get("fill", "black"), style)


def is_white(style: Mapping[str, str]) -> bool:
    """Return whether a shape's area is painted in the white of paper, or in a tint as light."""
    rgb = colour_of(style.get("fill", "black"), style)
    return rgb is not None and min(rgb) >= WHITE_MIN


def is_black(style: Mapping[str, str]) -> bool:
    """Return whether nothing of a shape, neither its edge nor its area, is painted in another colour than black."""
    paints = (("stroke", is_stroked(style), "none"), ("fill", is_filled(style), "black"))
    return all(
        not shows or colour_of(style.get(name, usual), style) == (0.0, 0.0, 0.0) for name, shows, usual in paints
    )


def colour_of(paint: str, style: Mapping[str, str]) -> Rgb | None:
    """Return the colour of a paint; None if it has none."""
    return css_rgb(_own(paint, style))


def _own(paint: str, style: Mapping[str, str]) -> str:
    """Return a paint in small letters, with the colour that `currentColor` stands for."""
    text = paint[:_LONGEST].strip().lower()
    return style.get("color", "black")[:_LONGEST].strip().lower() if text == "currentcolor" else text


def _is_paint(paint: str, style: Mapping[str, str]) -> bool:
    text = _own(paint, style)
    return text not in ("", "none", "transparent") and alpha_of(text) > 0.0


def _is_zero(text: str | None) -> bool:
    found = _NUMBER.match((text or "")[:_LONGEST])
    return found is not None and float(found[1]) <= 0.0
