"""How each kind of fold looks in files and in the 3D view, and which colours of a drawing mean it.

The page has the same colours in `static/css/fold_kinds.css`.
"""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class FoldLook:
    """How a kind of fold looks.

    Attributes:
        light, dark: the colour of its line on a light and on a dark ground, as ``RRGGBB``.
        hues_deg: the hues that mean it in a drawing, from the least to the greatest (degrees, from -180).
        layer: the word that means it in the name of a drawing's layer.
        dashes_cm: the lengths of its line's dashes and gaps by turns, in files (cm); none where it is solid.
        dashes_m: the same in the 3D view, where lines are seen from further off (m).
    """

    light: str
    dark: str
    hues_deg: tuple[float, float]
    layer: str
    dashes_cm: tuple[float, ...] = ()
    dashes_m: tuple[float, ...] = ()


FOLD_LOOKS: Mapping[str, FoldLook] = {
    "blue": FoldLook("0047a3", "7cc0ff", (-165.0, -95.0), "blue"),
    "red": FoldLook("b33600", "ffa070", (-25.0, 25.0), "red", (1.4, 0.5, 0.3, 0.5), (0.045, 0.012, 0.006, 0.012)),
    "turn": FoldLook("00693e", "6fdca9", (154.0, 157.0), "turnover", (1.2, 0.6), (0.03, 0.015)),
}
"""The looks of all kinds, by their names."""
