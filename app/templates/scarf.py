"""A scarf, or any strip: the near quarter over, then on at the half. Defaults: the shipped scarf (paper, Table 1)."""

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_away

INSIDE_M, BESIDE_M = 0.03, 0.2
"""Placement of a strip (m): left of the table's middle, where neither arm has to reach across the other."""

MEASURES = (Measure("width_m", "Width", "across", 0.254), Measure("length_m", "Length", "from end to end", 1.524))


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: the near quarter over, then the doubled part over the middle."""
    width, length = given["width_m"], given["length_m"]
    outline = ((0.0, 0.0), (width, 0.0), (width, length), (0.0, length))
    folds = (
        fold("near end up a quarter", (width, length / 4), (0.0, length / 4)),
        fold("on at the half", (width, length / 2), (0.0, length / 2)),
    )
    return Cut(outline, folds, lying_away(outline, INSIDE_M, BESIDE_M))


TEMPLATE = Template("scarf", "Scarf", "A strip; a quarter over, then on at the half.", 0.2, MEASURES, cut)
