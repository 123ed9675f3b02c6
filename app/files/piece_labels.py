"""What labels of pattern pieces say: that a piece is cut on the fold, and its graded size.

Programs write them as texts, as names of layers, groups, blocks and lines, or as markers at the ends of a line.
"""

import re
import unicodedata
from collections.abc import Iterable

_ON_FOLD = (
    "onfold",
    "onthefold",
    "mirrorline",
    "stoffbruch",
    "imbruch",
    "stofvouw",
    "aupli",
    "surlepli",
    "surlapliure",
    "alapliure",
    "pliuredutissu",
    "enelpliegue",
    "enelpliegedelatela",
    "aldoblez",
    "endoblez",
    "doblezdelatela",
    "doblezdetela",
)
"""Words for a fold line, small and without spaces: English, German, Dutch, French, Spanish."""

_FOLD_ALONE = frozenset(
    {
        "bruch",
        "bruchkante",
        "bruchlinie",
        "pliure",
        "lignedepliure",
        "doblez",
        "lineadedoblez",
        "líneadedoblez",
    }
)
"""Labels that say so if they say nothing else, small and without spaces; a line in colour they call a fold."""

_LETTERS = ("xxxxs", "xxxs", "xxs", "xs", "s", "m", "l", "xl", "xxl", "xxxl", "xxxxl")
_LETTER = re.compile(r"x{0,4}[sl]|m|[2-6]x[sl]")
_SIZE = re.compile(
    r"(?:^|[^a-z])(?:size|groesse|größe|gr|taille|talla|maat)[\W_]*([0-9]{1,3}[a-z]?|[2-6]?x{0,4}[sml])(?![a-z0-9])"
)
_GIVEN = re.compile(
    r"(path|rect|polygon|polyline|line|circle|ellipse|curve|shape|object|group|layer|ebene|calque|capa|svg|use|clip|g)?"
    r"[\W_\d]*|.*\d{3,}"
)
_ALONE = re.compile(r"_?(\d{2,3})")


def says_on_fold(label: str) -> bool:
    """Return whether a label says that a piece is cut on the fold, as in ``Cut on fold`` or ``front.cutonfold``."""
    plain = re.sub(r"[\W_\d]+", "", label.lower())
    return any(word in plain for word in _ON_FOLD)


def names_fold(label: str) -> bool:
    """Return whether a label is nothing but a word for a fold, as in ``Pliure`` or ``Bruch``."""
    return re.sub(r"[\W_\d]+", "", unicodedata.normalize("NFC", label).lower()) in _FOLD_ALONE


def size_in(label: str) -> str | None:
    """Return the size that a label names, as in ``SIZE: M``, ``back-XL``, ``Größe 38`` or ``40``; None for none."""
    text = label.strip().lower()
    if said := _SIZE.search(text):
        return said[1].upper()
    if number := _ALONE.fullmatch(text):
        return number[1]
    words = [word for word in re.split(r"[\W_]+", text) if word]
    ends = (words[-1], words[0]) if words else ()
    return next((word.upper() for word in ends if _LETTER.fullmatch(word)), None)


def piece_in(label: str) -> str | None:
    """Return the piece that a label names; None for a name that a program gave, as ``path12`` or ``Layer 1``."""
    plain = " ".join(label.split())[:40]
    return plain if plain and not _GIVEN.fullmatch(plain.lower()) else None


def in_order(sizes: Iterable[str]) -> list[str]:
    """Return sizes from small to large: letters, then numbers, then others by name."""
    return sorted(sizes, key=_rank)


def _rank(size: str) -> tuple[int, float, str]:
    plain = size.lower()
    if many := re.fullmatch(r"([2-6])x([sl])", plain):
        plain = int(many[1]) * "x" + many[2]
    if plain in _LETTERS:
        return (0, _LETTERS.index(plain), size)
    if _LETTER.fullmatch(plain):
        return (0, len(_LETTERS) + len(plain) if plain.endswith("l") else -len(plain), size)
    number = re.match(r"\d+", plain)
    return (1, float(number[0]), size) if number else (2, 0.0, size)
