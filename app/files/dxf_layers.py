"""The meaning of DXF layers: by ASTM D6673 in sewing patterns, otherwise by the layer's name.

ASTM D6673 (Standard Practice for Sewn Products Pattern Data Interchange, which took over ANSI/AAMA-292) has one block
for each piece of a pattern, and in it, as summed up at
https://fabricesalvaire.github.io/Patro/resources/file-format/dxf-astm.html, these layers:

====  =====================================  ====  ==============================
   1  piece boundary                            9  stripe reference lines
   2  turn points                              10  plaid reference lines
   3  curve points                             11  internal cutouts
   4  notches                                  12  left blank
   5  grade reference lines                    13  drill holes
   6  mirror line                              14  sew lines
   7  grain line                               15  annotation text
   8  internal lines, not cut               80-87  further notches, checks, text
====  =====================================  ====  ==============================

None of these layers is for folds. A pattern can carry them on layer 8, for lines that are drawn but not cut.
"""

import re
from collections.abc import Iterable

from app.fold_looks import FOLD_LOOKS

BOUNDARY = "1"
MIRROR_LINE = "6"
INTERNAL_LINES = "8"

_NUMBERED = re.compile(r"\d{1,2}")
_METRIC_UNITS = re.compile(r"^\s*units\s*:?\s*(metric|english)", re.IGNORECASE)
_SIZE = re.compile(r"^\s*size\s*:\s*(\S.{0,30}?)\s*$", re.IGNORECASE)
_PIECE = re.compile(r"^\s*piece\s*name\s*:\s*(\S.{0,39}?)\s*$", re.IGNORECASE)
_SAMPLE = re.compile(r"^\s*sample\s*size\s*:\s*(\S.{0,30}?)\s*$", re.IGNORECASE)
_UNIT_M = {"metric": 1e-3, "english": 0.0254}

INSUNITS_M = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 10: 0.9144, 14: 0.1}
"""Length of a drawing's unit by the header's $INSUNITS (m): inch, foot, mm, cm, m, yard, dm."""


def may_carry_folds(layer: str) -> bool:
    """Return whether a coloured line on a layer of a sewing pattern may mean a fold."""
    return layer == INTERNAL_LINES or _NUMBERED.fullmatch(layer) is None


def kind_by_name(layer: str) -> str | None:
    """Return the kind of fold that a layer's name mentions, as in ``Fold blue``, or None."""
    words = set(re.split(r"[^a-z]+", layer.lower()))
    return next((kind for kind, look in FOLD_LOOKS.items() if look.layer in words), None)


def unit_by_text(texts: Iterable[str]) -> float | None:
    """Return the unit's length by the text ``UNITS: METRIC`` (mm) or ``UNITS: ENGLISH`` (inches), or None (m)."""
    found = (_METRIC_UNITS.match(text) for text in texts)
    return next((_UNIT_M[match[1].lower()] for match in found if match), None)


def size_by_text(texts: Iterable[str]) -> str | None:
    """Return a piece's size by the text ``SIZE: M`` in its block, or None."""
    return next((match[1] for match in map(_SIZE.match, texts) if match), None)


def piece_by_text(texts: Iterable[str]) -> str | None:
    """Return a piece's name by the text ``PIECE NAME: FRONT`` in its block, or None."""
    return next((match[1] for match in map(_PIECE.match, texts) if match), None)


def sample_by_text(texts: Iterable[str]) -> str | None:
    """Return a style's sample size by the text ``SAMPLE SIZE: M``, or None."""
    return next((match[1] for match in map(_SAMPLE.match, texts) if match), None)
