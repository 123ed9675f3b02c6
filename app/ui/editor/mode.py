"""What a visitor of the stage does with the pointer, and which folds the pointer draws."""

from enum import StrEnum


class Mode(StrEnum):
    """What the left button does; the words are those in the panel."""

    LOOK = "Look"
    MOVE_POINTS = "Move points"
    DRAW_OUTLINE = "Draw outline"
    DRAW_FOLD = "Draw fold"


class FoldKind(StrEnum):
    """Which layers a fold takes; the words are those in the panel."""

    BLUE = "Blue: all layers"
    RED = "Red: last flap"
