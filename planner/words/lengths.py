"""Lengths, places, directions and folds in words: metres or centimetres, directions as the robot sees them.

The robot is taken to look at the table from its near edge.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeAlias

from planner.geometry.tolerance import LENGTH_M

Values: TypeAlias = Mapping[str, Any]
"""The named values of a message."""


class Named(Protocol):
    """What sentences need of a fold."""

    @property
    def name(self) -> str:
        """The fold's name."""


Folds: TypeAlias = Sequence[Named]
"""The folds of the garment that a message is about, in the user's order."""

SHORT_M = 0.0095
"""Length below which millimetres are shown (m)."""

_NOTICEABLE_M = 0.0005
"""Length below which a component of a move is left out of the words (m)."""


def called(folds: Folds, index: int) -> str:
    """Return a fold's number and name."""
    return f"fold {index} '{folds[index].name}'"


def counted_hands(count: int) -> str:
    """Return a number of hands in words."""
    return "one hand" if count == 1 else f"{count} hands"


def in_cm(length_m: float) -> str:
    """Return a length in words, as in "12.5 cm"."""
    return f"{100.0 * length_m:.3g} cm"


def in_metres(length_m: float) -> str:
    """Return a length in metres, without its unit: to the centimetre, or the millimetre if it is short."""
    return f"{length_m:.{2 if length_m >= SHORT_M else 3}f}"


def rounded_up(number: float, decimals: int = 3) -> str:
    """Return a number that is enough, rounded up."""
    scale = 10.0**decimals
    return f"{math.ceil(number * scale - LENGTH_M) / scale:.{decimals}f}"


def rounded_down(number: float) -> str:
    """Return a number that is available, rounded down to three decimals."""
    return f"{math.floor(number * 1000.0 + LENGTH_M) / 1000.0:.3f}"


def in_degrees(angle_rad: float) -> str:
    """Return an angle in whole degrees, without the unit."""
    return f"{math.degrees(angle_rad):.0f}"


def height(z: float) -> str:
    """Return the height of a point over the table top (m) in words; negative below it, where cloth hangs."""
    return f"{z:.2f} m over the table" if z >= 0.0 else f"{-z:.2f} m below the table's top"


def point(at: Sequence[float]) -> str:
    """Return the first two coordinates of a point, as in "(0.12, 0.30)" (m)."""
    return f"({at[0]:.2f}, {at[1]:.2f})"


def on_garment(points: Sequence[Sequence[float]]) -> str:
    """List points of the garment (m)."""
    return f"{' and '.join(point(at) for at in points)} m of the garment"


def moved(dx_m: float, dy_m: float) -> str:
    """Put a move in the table frame into words, as in "8 cm towards the robot and 5 cm to the left"; empty for none."""
    parts = []
    if abs(dx_m) > _NOTICEABLE_M:
        parts.append(f"{in_cm(abs(dx_m))} {_ahead(dx_m)}")
    if abs(dy_m) > _NOTICEABLE_M:
        parts.append(f"{in_cm(abs(dy_m))} {_aside(dy_m)}")
    return " and ".join(parts)


def direction(x: float, y: float) -> str:
    """Put a direction in the table frame into words, as in "towards the robot".

    Both axes are named where the direction is more than 22 degrees off either axis.
    """
    oblique = 0.4
    parts = []
    if abs(x) > oblique * abs(y):
        parts.append(_ahead(x))
    if abs(y) > oblique * abs(x):
        parts.append(_aside(y))
    return " and ".join(parts)


def carried(values: Values) -> str:
    """Return in words how far drags had brought the cloth, from the values `dragged` and `is_held`."""
    offset = values.get("dragged")
    if not offset or math.hypot(*offset) <= LENGTH_M:
        return ""
    x, y = (LENGTH_M * round(c / LENGTH_M) + 0.0 for c in offset)
    hold = " and held on to" if values["is_held"] else ""
    return f" (the cloth dragged by ({x:.2f}, {y:.2f}) m from where it starts{hold})"


def _ahead(x: float) -> str:
    return "away from the robot" if x > 0.0 else "towards the robot"


def _aside(y: float) -> str:
    return "to the left" if y > 0.0 else "to the right"
