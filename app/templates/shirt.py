"""A shirt with long sleeves: cuff, sleeve and side in on either side, then bottom up.

Defaults: the shipped child's shirt (paper, Table 1).
"""

import math

import numpy as np

from app.templates.measure import Measure, Measures
from app.templates.mirrored import both_folds, both_halves
from app.templates.template import Cut, Template, fold, lying_away
from planner.cloth.garment import DrawnFold
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment

MEASURES = (
    Measure("width_m", "Width", "from armpit to armpit", 0.279),
    Measure("length_m", "Length", "from the hem to the shoulder", 0.381),
    Measure("armhole_m", "Armhole", "from the armpit straight up to the shoulder", 0.127, ("length_m",)),
    Measure("sleeve_m", "Sleeve", "along its upper edge, from the shoulder to the cuff", 0.322, ("width_m",)),
    Measure("slope_m", "Slope", "how far the sleeve's upper edge falls", 0.102, ("sleeve_m", "length_m"), min_m=0.0),
    Measure("cuff_m", "Cuff", "the sleeve's opening, laid flat", 0.08, ("armhole_m", "width_m")),
    Measure("folded_width_m", "Folded width", "how wide it is when its sides are folded in", 0.139, ("width_m",)),
)

_STEEPEST = 0.7
"""Largest fall of a sleeve, as a share of its length."""


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: on either side half the sleeve back, sleeve in, side in; then bottom up."""
    width, length, folded = given["width_m"], given["length_m"], given["folded_width_m"]
    given.require_less("armhole_m", length / 2, "half of the length")
    given.require_less("slope_m", _STEEPEST * given["sleeve_m"], f"{_STEEPEST} of the sleeve")
    # A sleeve that widens towards its cuff would have it stick out below the armpit once half of it is folded back.
    across = math.sqrt(1.0 - (given["slope_m"] / given["sleeve_m"]) ** 2) * given["armhole_m"]
    given.require_less("cuff_m", across, "the armhole, square to the sleeve")
    given.require_less(
        "slope_m", length - given["cuff_m"], "the length less the cuff, or the sleeve would pass the hem"
    )
    given.require_less("sleeve_m", 2 * (width - given["cuff_m"]), "twice the width less the cuff")
    given.require_less("folded_width_m", width, "the width")
    given.require_at_least("folded_width_m", width / 3, "a third of the width, or the sides would stick out")
    armpit, shoulder = (0.0, length - given["armhole_m"]), (0.0, length)
    upper, lower = _cuff(given)
    given.require_less("cuff_m", _STEEPEST * given["sleeve_m"], f"{_STEEPEST} of the sleeve")
    outline = both_halves(((0.0, 0.0), armpit, lower, upper, shoulder), width)
    side = (width - folded) / 2
    left = (
        _half_back(armpit, lower, Segment(shoulder, upper)),
        fold("left sleeve", armpit, shoulder),
        fold("left side", (side, 0.0), (side, length)),
    )
    up = fold("bottom up", (width - side, length / 2), (side, length / 2))
    return Cut(outline, (*both_folds(left, width), up), lying_away(outline))


def _cuff(given: Measures) -> tuple[Point2, Point2]:
    """Return the upper and the lower corner of the left cuff, which is square to the sleeve's upper edge."""
    fall = given["slope_m"] / given["sleeve_m"]
    out = math.sqrt(1.0 - fall**2)
    x, y = -out * given["sleeve_m"], given["length_m"] - given["slope_m"]
    return (x, y), (x + fall * given["cuff_m"], y - out * given["cuff_m"])


def _half_back(armpit: Point2, lower: Point2, top: Segment) -> DrawnFold:
    """Return the fold across the sleeve, from the middle of its underside, perpendicular to its upper edge."""
    middle = ((armpit[0] + lower[0]) / 2, (armpit[1] + lower[1]) / 2)
    foot = top.at(float(top.positions(np.array([middle]))[0]))
    return fold("left cuff", middle, foot)


TEMPLATE = Template(
    "shirt", "Long-sleeved shirt", "Long sleeves; cuffs, sleeves and sides in, bottom up.", 0.14, MEASURES, cut, 0.0004
)
