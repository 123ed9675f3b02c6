"""Messages about a drawing in the stage's words: in centimetres, corners and edges counted from 1.

The page has words of its own, in the unit that its reader has chosen (`static/js/messages`).
"""

from collections.abc import Callable, Mapping
from typing import Any

from planner.geometry.pose import Point2
from planner.message import Message

_Values = Mapping[str, Any]


def spoken(says: Message | None, sentence: str) -> str:
    """Return a message in the stage's words; its sentence where the stage has no words for it."""
    words = None if says is None else _WORDS.get(says.code)
    return sentence if words is None or says is None else words(says.values)


def _cm(length_m: float) -> str:
    return f"{100.0 * length_m:.1f}".removesuffix(".0") + " cm" if length_m >= 0.001 else f"{100.0 * length_m:.2g} cm"


def _at(point: Point2) -> str:
    x, y = (f"{100.0 * coordinate + 0.0:.1f}".removesuffix(".0") for coordinate in point)
    return f"({x}, {y}) cm of the garment"


def _edge_too_short(values: _Values) -> str:
    edge, least = values["edge"] + 1, _cm(values["least_m"])
    return f"edge {edge} is {_cm(values['length_m'])} long, less than {least}"


def _edges_cross(values: _Values) -> str:
    first, second = values["edges"]
    return f"edges {first + 1} and {second + 1} cross at {_at(values['at'])}"


def _outline_area(values: _Values) -> str:
    return f"it covers {1e4 * values['area_m2']:.2g} cm², less than {1e4 * values['least_m2']:g} cm²"


def _end_off_boundary(values: _Values) -> str:
    off, most = _cm(values["off_m"]), _cm(values["most_m"])
    return f"its end at {_at(values['at'])} is {off} from the cloth's edge; ends within {most} snap to it"


def _line_too_short(values: _Values) -> str:
    return f"the line is {_cm(values['length_m'])} long, less than {_cm(values['least_m'])}"


def _would_tear(values: _Values) -> str:
    return f"the part that moves reaches {_cm(values['along_m'])} along the crease of the fold before: it would tear"


_WORDS: Mapping[str, Callable[[_Values], str]] = {
    "edge_too_short": _edge_too_short,
    "edges_cross": _edges_cross,
    "outline_area": _outline_area,
    "end_off_boundary": _end_off_boundary,
    "line_too_short": _line_too_short,
    "would_tear": _would_tear,
}
