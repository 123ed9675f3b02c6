"""The modes of a visitor's pointer, and the kinds of fold that it draws."""

from enum import StrEnum


class Mode(StrEnum):
    """The left button's mode, by the key of its label in the panel."""

    LOOK = "mode.look"
    MOVE_POINTS = "mode.move_points"
    DRAW_OUTLINE = "tool.outline"
    DRAW_FOLD = "tool.fold"


class FoldKind(StrEnum):
    """The layers that a fold takes, by the key of their label in the panel."""

    BLUE = "colour.blue_all_layers"
    RED = "colour.red_last_flap"
