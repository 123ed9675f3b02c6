"""A round cloth, folded in half and then into a quarter.

Two hands can fold it only up to a diameter of about 0.34 m, since they must hold every corner of the moving edge. Half
of the edge of a circle of radius R lies within 0.77 R of two points on it, and a grip holds the cloth within 0.127 m.
"""

import math

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_away

CORNERS = 48
"""Number of corners that approximate the circle."""

MEASURES = (Measure("diameter_m", "Diameter", "straight across", 0.32),)


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: the near half over, then the left half of that."""
    radius = given["diameter_m"] / 2
    turns = [math.tau * number / CORNERS for number in range(CORNERS)]
    outline = tuple((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns)
    folds = (fold("half", (radius, 0.0), (-radius, 0.0)), fold("quarter", (0.0, 0.0), (0.0, radius)))
    return Cut(outline, folds, lying_away(outline))


TEMPLATE = Template("round", "Round cloth", "A circle; in half, then a quarter.", 0.2, MEASURES, cut)
