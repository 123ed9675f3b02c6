"""A skirt laid sideways: along its axis, the far part back, waist to hem.

Defaults: the shipped skirt (paper, Table 1).
"""

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_away

MEASURES = (
    Measure("length_m", "Length", "from the waist to the hem", 0.432),
    Measure("waist_m", "Waist", "from side to side, laid flat", 0.33, ("hem_m",)),
    Measure("hem_m", "Hem", "from side to side, laid flat", 0.775, ("waist_m",)),
)


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: half over half along its axis, half of that back, the waist onto the hem."""
    length, waist, hem = (given[name] for name in ("length_m", "waist_m", "hem_m"))
    given.require_less("waist_m", hem + 1e-3, "the hem and {} more", 1e-3)
    low, high, axis, back = (hem - waist) / 2, (hem + waist) / 2, hem / 2, 0.75 * hem
    outline = ((0.0, low), (length, 0.0), (length, hem), (0.0, high))
    begin = max(0.0, (back - high) / (hem - high) * length) if hem > high else 0.0
    folds = (
        fold("along its axis", (length, axis), (0.0, axis)),
        fold("far part back", (begin, back), (length, back)),
        fold("waist to hem", (length / 2, axis), (length / 2, back)),
    )
    return Cut(outline, folds, lying_away(outline))


TEMPLATE = Template("skirt", "Skirt", "Flared; along its axis, the far part back, waist to hem.", 0.22, MEASURES, cut)
