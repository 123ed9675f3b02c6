"""Trousers: leg on leg, then hem onto waist. Defaults: the shipped jeans (paper, Table 1)."""

from app.templates.measure import Measure, Measures
from app.templates.template import Cut, Template, fold, lying_towards

MEASURES = (
    Measure("waist_m", "Waist", "from side to side, laid flat", 0.305),
    Measure("length_m", "Length", "along the side, from the hem to the waist", 0.864),
    Measure("inseam_m", "Inseam height", "from the hem straight up to the crotch", 0.61, ("length_m",)),
    Measure("hem_m", "Hem", "a leg's opening, laid flat", 0.102, ("waist_m",)),
)

BESIDE_M = 0.1
"""How far to the right of the table's middle trousers lie: leg on leg is in reach there without a drag (m)."""


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: the left leg onto the right, then the hems onto the waist."""
    waist, length, inseam, hem = (given[name] for name in ("waist_m", "length_m", "inseam_m", "hem_m"))
    given.require_less("inseam_m", length - 0.05, "the length less {}", 0.05)
    given.require_less("hem_m", waist / 2 - 0.005, "half of the waist less {}", 0.005)
    middle = waist / 2
    outline = (
        (0.0, 0.0),
        (hem, 0.0),
        (middle, inseam),
        (waist - hem, 0.0),
        (waist, 0.0),
        (waist, length),
        (0.0, length),
    )
    height = length / 2
    inner = middle if height >= inseam else middle + (waist - hem - middle) * (inseam - height) / inseam
    folds = (
        fold("leg on leg", (middle, inseam), (middle, length)),
        fold("hem onto waist", (waist, height), (inner, height)),
    )
    return Cut(outline, folds, lying_towards(outline, -BESIDE_M))


TEMPLATE = Template("trousers", "Trousers", "Two legs; leg on leg, then hem onto waist.", 0.4, MEASURES, cut)
