"""Messages about a drawing, localized for the 3D view: in its reader's language, in centimetres, counted from 1.

The words are those of the page (`static/words`); the page fills them in the unit that its reader has chosen.
"""

from collections.abc import Mapping
from typing import Any

from app.language import Language, catalogue, numeral, say
from planner.geometry.pose import Point2
from planner.message import Message

_LOCALIZED = frozenset(
    {
        "dropped_too_near",
        "edge_too_short",
        "edges_cross",
        "end_off_boundary",
        "fewer_folds",
        "folds_full",
        "line_too_short",
        "no_cloth_there",
        "not_on_flap",
        "outline_area",
        "outline_points",
        "would_tear",
    }
)
"""The codes of messages whose words are filled by `_places`."""

_COUNTED = frozenset({"edge", "from", "to"})


def localized(language: Language, says: Message | None, sentence: str) -> str:
    """Return a message in a language; its English sentence if the catalogue has no text for it."""
    if says is None or says.code not in _LOCALIZED or f"message.{says.code}" not in catalogue(language):
        return sentence
    return say(language, f"message.{says.code}", **_places(language, says.values))


def _places(language: Language, values: Mapping[str, Any]) -> dict[str, str]:
    """Return the texts for the places of a message, named like its values without their units."""
    found: dict[str, str] = {}
    for name, value in values.items():
        if name == "edges":
            found["first"], found["second"] = (str(edge + 1) for edge in value)
        elif name == "at":
            found[name] = _at(language, value)
        elif name.endswith("_m2"):
            found[name.removesuffix("_m2")] = f"{_figure(language, 1e4 * value)} cm²"
        elif name.endswith("_m"):
            found[name.removesuffix("_m")] = f"{_figure(language, 100.0 * value)} cm"
        else:
            found[name] = str(value + 1 if name in _COUNTED else value)
    return found


def _at(language: Language, point: Point2) -> str:
    x, y = (_figure(language, 100.0 * coordinate) for coordinate in point)
    return say(language, "point.of_garment", point=say(language, "point", x=x, y=y, unit="cm"))


def _figure(language: Language, value: float) -> str:
    """Return a number with at most one digit behind the mark; what is tiny keeps two that say something."""
    tenths = round(value, 1)
    if tenths == 0.0 and abs(value) >= 1e-4:
        return numeral(language, float(f"{value:.2g}"), 4).rstrip("0")
    return numeral(language, tenths + 0.0, 0 if tenths == round(tenths) else 1)
