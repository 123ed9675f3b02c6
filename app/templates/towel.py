"""A towel, or any rectangle: half over, then either side in. Defaults: the shipped hand towel (paper, Table 1)."""

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_away

MEASURES = (
    Measure("width_m", "Width", "the side along which the robot stands", 0.686),
    Measure("length_m", "Length", "the other side", 0.419),
    Measure("folded_width_m", "Folded width", "how wide it is when its sides are folded in", 0.298, ("width_m",)),
)


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: the near half over, then the left and the right side in."""
    width, length, folded = given["width_m"], given["length_m"], given["folded_width_m"]
    given.require_less("folded_width_m", width - 0.02, "the width less {}", 0.02)
    given.require_at_least("folded_width_m", width / 3, "a third of the width, or the sides would stick out")
    half, side = length / 2, (width - folded) / 2
    outline = ((0.0, 0.0), (width, 0.0), (width, length), (0.0, length))
    folds = (
        fold("half", (width, half), (0.0, half)),
        fold("left side", (side, half), (side, length)),
        fold("right side", (width - side, length), (width - side, half)),
    )
    return Cut(outline, folds, lying_away(outline))


TEMPLATE = Template("towel", "Towel", "A rectangle; in half, then both sides in.", 0.45, MEASURES, cut)
