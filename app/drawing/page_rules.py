"""Write the rules of drawing for the page: `python -m app.drawing.page_rules FILE`."""

import json
import sys
from pathlib import Path

from app.drawing import rules
from app.drawing.curve import CURVE_MAX, CURVE_TOLERANCE_M
from planner.cloth.garment import FIRST_IS_RED
from planner.cloth.outline import POINTS_MAX


def page_rules() -> str:
    """Return the page's module of the numbers and sentences in `app.drawing.rules`."""
    values = {
        "REACH_PX": rules.SNAP_PX,
        "FRACTIONS": rules.FRACTIONS,
        "HANDLE_PX": rules.HANDLE_PX,
        "FINGER_PX": rules.FINGER_PX,
        "LEAST_CORNERS": rules.LEAST_CORNERS,
        "MOST_CORNERS": POINTS_MAX,
        "SAME_CORNER_M": rules.SAME_CORNER_M,
        "STROKE_MIN_M": rules.STROKE_MIN_M,
        "CURVE_TOLERANCE_M": CURVE_TOLERANCE_M,
        "CURVE_MAX": CURVE_MAX,
        "SIDES": rules.SIDES,
        "DRAW_FOLD": rules.DRAW_FOLD,
        "DRAW_OUTLINE": rules.DRAW_OUTLINE,
        "MOVE_CORNER": rules.MOVE_CORNER,
        "NO_CLOTH": rules.as_sentence(rules.NO_CLOTH),
        "FIRST_IS_RED": rules.as_sentence(FIRST_IS_RED),
        "CORNER_TAKEN": rules.as_sentence(rules.CORNER_TAKEN),
        "TOO_MANY_CORNERS": rules.as_sentence(rules.TOO_MANY_CORNERS),
        "TOO_FEW_CORNERS": rules.as_sentence(rules.TOO_FEW_CORNERS),
    }
    told = "/** The rules of drawing of both editors: written by `make page-rules` from `app/drawing/rules.py`. */\n"
    return told + "".join(f"\nexport const {name} = {json.dumps(value)};\n" for name, value in values.items())


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page_rules())
