"""A vest, or tank top: half over half, then the lower half up.

Defaults: the shipped vest (paper, Table 1).
"""

from app.templates.measure import Measure, Measures
from app.templates.mirrored import both_halves
from app.templates.template import Cut, Template, fold, lying_across

MEASURES = (
    Measure("width_m", "Width", "from armpit to armpit", 0.508),
    Measure("length_m", "Length", "from the hem to the straps", 0.61),
    Measure("armhole_m", "Armhole", "from the armpit straight up to the straps' height", 0.204, ("length_m",)),
    Measure("shoulder_m", "Shoulder", "how far a strap is in from the side", 0.051, ("width_m",)),
    Measure("strap_m", "Strap", "how wide a strap is", 0.051, ("width_m",)),
    Measure("neck_m", "Neck", "how deep the neck is, from the straps' height", 0.204, ("length_m",)),
)


def cut(given: Measures) -> Cut:
    """Return the pattern and its folds: the left half onto the right along the middle, then the lower half up."""
    width, length, neck = given["width_m"], given["length_m"], given["length_m"] - given["neck_m"]
    inner = given["shoulder_m"] + given["strap_m"]
    given.require_less("armhole_m", length / 2, "half of the length")
    given.require_less("neck_m", length / 2, "half of the length")
    given.require_less(
        "strap_m", width / 2 - given["shoulder_m"] - 0.01, "half of the width less the shoulder and {}", 0.01
    )
    left = ((0.0, 0.0), (0.0, length - given["armhole_m"]), (given["shoulder_m"], length), (inner, length))
    half = both_halves(left, width)
    outline = (*half[: len(left)], (width / 2, neck), *half[len(left) :])
    folds = (
        fold("centre line", (width / 2, 0.0), (width / 2, neck)),
        fold("half height", (width, length / 2), (width / 2, length / 2)),
    )
    return Cut(outline, folds, lying_across(outline))


TEMPLATE = Template(
    "vest", "Vest", "No sleeves; in half along its middle, then bottom up.", 0.16, MEASURES, cut, 0.0006
)
