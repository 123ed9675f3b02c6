"""A scarf, or any strip: the near quarter over, then on at the half. The defaults are the shipped one's (Table 1)."""

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_away

INSIDE_M, BESIDE_M = 0.03, 0.2
"""A strip lies to the left of the table's middle, where one arm does not have to reach across the other (m)."""

MEASURES = (
    Measure("width_m", "Width", "across", 0.254),
    Measure("length_m", "Length", "from end to end", 1.524),
)


def cut(given: Measures) -> Cut:
    """Folds: the near quarter over, and what lies double then over the middle."""
    width, length = given["width_m"], given["length_m"]
    outline = ((0.0, 0.0), (width, 0.0), (width, length), (0.0, length))
    folds = (
        fold("near end up a quarter", (width, length / 4), (0.0, length / 4)),
        fold("on at the half", (width, length / 2), (0.0, length / 2)),
    )
    return Cut(outline, folds, lying_away(outline, INSIDE_M, BESIDE_M))


TEMPLATE = Template("scarf", "Scarf", "A strip; a quarter over, then on at the half.", 0.2, MEASURES, cut)
