"""A tie, folded quarter by quarter towards the wide end. Defaults: the shipped tie (paper, Table 1)."""

import numpy as np

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_away

INSIDE_M, BESIDE_M = 0.03, 0.1
"""Placement (m): distance inside the table's near edge, and shift to the left of its middle."""

NAMES = ("narrow end up a quarter", "on at the half", "on again")
MEASURES = (
    Measure("length_m", "Length", "from tip to tip", 1.498),
    Measure("wide_m", "Wide end", "across its corners", 0.102),
    Measure("narrow_m", "Narrow end", "across its corners", 0.038, ("wide_m",)),
    Measure("wide_tip_m", "Wide tip", "from the corners to the tip", 0.051, ("length_m",)),
    Measure("narrow_tip_m", "Narrow tip", "from the corners to the tip", 0.025, ("length_m",)),
)


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: at each quarter of its length, from the narrow end on."""
    length, wide, narrow = given["length_m"], given["wide_m"], given["narrow_m"]
    given.require_less("narrow_m", wide + 1e-3, "the wide end and {} more", 1e-3)
    given.require_less("narrow_tip_m", length, "the length")
    given.require_less("wide_tip_m", length - given["narrow_tip_m"], "the length without the narrow tip")
    low, middle = -given["narrow_tip_m"], narrow / 2
    high = low + length
    shoulder = high - given["wide_tip_m"]
    outline = (
        (0.0, 0.0),
        (middle, low),
        (narrow, 0.0),
        (middle + wide / 2, shoulder),
        (middle, high),
        (middle - wide / 2, shoulder),
    )
    folds = []
    for number, name in enumerate(NAMES):
        height = low + (number + 1) * length / 4
        half = float(np.interp(height, (low, 0.0, shoulder, high), (0.0, narrow, wide, 0.0))) / 2
        folds.append(fold(name, (middle + half, height), (middle - half, height)))
    return Cut(outline, tuple(folds), lying_away(outline, INSIDE_M, BESIDE_M))


TEMPLATE = Template("tie", "Tie", "Pointed at both ends; quarter by quarter onto the wide end.", 0.25, MEASURES, cut)
