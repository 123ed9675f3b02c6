"""A T-shirt: sleeves in, sides in, bottom up. Defaults: the shipped T-shirt (paper, Table 1)."""

from app.templates.measure import Measure, Measures
from app.templates.mirrored import both_folds, both_halves
from app.templates.template import Cut, Template, fold, lying_across

MEASURES = (
    Measure("width_m", "Width", "from armpit to armpit", 0.457),
    Measure("length_m", "Length", "from the hem to the shoulder", 0.61),
    Measure("armhole_m", "Armhole", "from the armpit straight up to the shoulder", 0.191, ("length_m",)),
    Measure("sleeve_m", "Sleeve", "how far its upper corner stands out beside the body", 0.152, ("width_m",)),
    Measure("underside_m", "Underside of the sleeve", "from the armpit straight out to the cuff", 0.102, ("sleeve_m",)),
    Measure("slope_m", "Slope", "how far the sleeve's upper edge falls", 0.038, ("armhole_m",), min_m=0.0),
    Measure("folded_width_m", "Folded width", "how wide it is when its sides are folded in", 0.257, ("width_m",)),
)


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: each sleeve along the body, each side, the lower half up."""
    width, length, folded = given["width_m"], given["length_m"], given["folded_width_m"]
    armpit = length - given["armhole_m"]
    given.require_less("armhole_m", length / 2, "half of the length")
    given.require_less("slope_m", given["armhole_m"], "the armhole")
    given.require_less("underside_m", given["sleeve_m"], "the sleeve")
    given.require_less("sleeve_m", width, "the width, or it would reach beyond the other side")
    given.require_less("folded_width_m", width, "the width")
    given.require_at_least("folded_width_m", width / 3, "a third of the width, or the sides would stick out")
    side = (width - folded) / 2
    left = (
        (0.0, 0.0),
        (0.0, armpit),
        (-given["underside_m"], armpit),
        (-given["sleeve_m"], length - given["slope_m"]),
        (0.0, length),
    )
    outline = both_halves(left, width)
    sleeves = both_folds((fold("left sleeve", (0.0, armpit), (0.0, length)),), width)
    sides = both_folds((fold("left side", (side, 0.0), (side, length)),), width)
    up = fold("bottom up", (width - side, length / 2), (side, length / 2))
    return Cut(outline, (*sleeves, *sides, up), lying_across(outline))


TEMPLATE = Template(
    "t-shirt", "T-shirt", "Short sleeves; sleeves and sides in, bottom up.", 0.16, MEASURES, cut, 0.0006
)
