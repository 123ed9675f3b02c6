"""The colours that the 3D view should show, on a light or a dark background.

The kinds of folds and the cloth's two faces stay distinguishable for every kind of colour vision.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from app.fold_looks import FOLD_LOOKS

Rgb: TypeAlias = tuple[int, int, int]


def rgb(code: str) -> Rgb:
    """Return a colour written as six hexadecimal digits."""
    red, green, blue = bytes.fromhex(code)
    return red, green, blue


def linear(colour: Rgb) -> tuple[float, float, float]:
    """Return a colour of a screen as shares of light, 0..1."""
    red, green, blue = (part / 255.0 for part in colour)
    return _light(red), _light(green), _light(blue)


def _light(part: float) -> float:
    return part / 12.92 if part <= 0.04045 else float(((part + 0.055) / 1.055) ** 2.4)


@dataclass(frozen=True, slots=True)
class Palette:
    """The colour of each thing in the 3D view."""

    cloth_front: Rgb = rgb("F0E6D2")
    cloth_back: Rgb = rgb("B4C3D6")
    cloth_edge: Rgb = rgb("6E6453")
    cloth_hem: Rgb = rgb("D8CCB4")
    cloth_simulated: Rgb = rgb("8C929B")
    cloth_off: Rgb = rgb("2E3238")
    folds: Mapping[str, Rgb] = field(
        default_factory=lambda: {kind: rgb(look.light) for kind, look in FOLD_LOOKS.items()}
    )
    table: Rgb = rgb("A2805F")
    table_foot: Rgb = rgb("8A6C50")
    floor: Rgb = rgb("B4B9BF")
    floor_cell: Rgb = rgb("C6C9CD")
    floor_section: Rgb = rgb("CFD2D5")
    route: Rgb = rgb("4A525D")
    grip: Rgb = rgb("202226")
    robot_light: Rgb = rgb("E6E8EA")
    robot_grey: Rgb = rgb("A9AEB5")
    robot_dark: Rgb = rgb("5A5F67")


LIGHT = Palette()

DARK = Palette(
    cloth_front=rgb("5A5142"),
    cloth_back=rgb("2C3B50"),
    cloth_edge=rgb("B5A98F"),
    cloth_hem=rgb("6B604F"),
    cloth_simulated=rgb("8E959E"),
    cloth_off=rgb("E4E4DF"),
    folds={kind: rgb(look.dark) for kind, look in FOLD_LOOKS.items()},
    table=rgb("35291F"),
    table_foot=rgb("2C221A"),
    floor=rgb("202329"),
    floor_cell=rgb("30343B"),
    floor_section=rgb("3A3F47"),
    route=rgb("B6BCC6"),
    grip=rgb("E8E8E4"),
    robot_light=rgb("A4A9B0"),
    robot_grey=rgb("747A83"),
    robot_dark=rgb("474B52"),
)
