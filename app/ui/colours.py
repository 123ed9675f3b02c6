"""The colours of the stage, seen before a light ground or a dark one.

Blue, red and the cloth's two faces keep apart for every kind of colour vision.
"""

from dataclasses import dataclass
from typing import TypeAlias

Rgb: TypeAlias = tuple[int, int, int]


def rgb(code: str) -> Rgb:
    """A colour written as six hexadecimal digits."""
    red, green, blue = bytes.fromhex(code)
    return red, green, blue


@dataclass(frozen=True, slots=True)
class Palette:
    """What each thing on the stage is painted with."""

    cloth_front: Rgb = rgb("F0E6D2")
    cloth_back: Rgb = rgb("B4C3D6")
    cloth_edge: Rgb = rgb("6E6453")
    fold_blue: Rgb = rgb("0047A3")
    fold_red: Rgb = rgb("B33600")
    table: Rgb = rgb("6A5D4F")
    table_foot: Rgb = rgb("4C443B")
    floor_cell: Rgb = rgb("A9ACB1")
    floor_section: Rgb = rgb("8C9096")
    station: Rgb = rgb("8A8F98")
    route: Rgb = rgb("5B6470")
    grip: Rgb = rgb("202226")
    robot_light: Rgb = rgb("DADCDF")
    robot_grey: Rgb = rgb("8E949C")
    robot_dark: Rgb = rgb("474B52")


LIGHT = Palette()
