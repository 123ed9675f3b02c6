"""A round cloth: half, then a quarter.

Every corner of its edge must be held. So one is folded by two hands only up to a diameter of about 0.34 m: half of a
circle's edge of radius R lies within 0.77 R of two points on it, and a grip holds what is within 0.127 m.
"""

import math

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_away

CORNERS = 48
MEASURES = (Measure("diameter_m", "Diameter", "straight across", 0.32),)


def cut(given: Measures) -> Cut:
    """Folds: the near half over, then the left half of that."""
    radius = given["diameter_m"] / 2
    turns = [math.tau * number / CORNERS for number in range(CORNERS)]
    outline = tuple((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns)
    folds = (
        fold("half", (radius, 0.0), (-radius, 0.0)),
        fold("quarter", (0.0, 0.0), (0.0, radius)),
    )
    return Cut(outline, folds, lying_away(outline))


TEMPLATE = Template("round", "Round cloth", "A circle; in half, then a quarter.", 0.2, MEASURES, cut)
