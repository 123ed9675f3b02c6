"""The modes of a visitor's pointer, and the kinds of fold that it draws."""

from enum import StrEnum


class Mode(StrEnum):
    """The left button's mode, by its label in the panel."""

    LOOK = "Look"
    MOVE_POINTS = "Move points"
    DRAW_OUTLINE = "Draw outline"
    DRAW_FOLD = "Draw fold"


class FoldKind(StrEnum):
    """The layers that a fold takes, by their label in the panel."""

    BLUE = "Blue: all layers"
    RED = "Red: last flap"
