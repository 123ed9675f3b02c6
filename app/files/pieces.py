"""The pieces of a pattern that lie side by side in a drawing: one of them is the garment."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from app.files.import_errors import ImportedFileError
from planner.geometry.arrangement import is_within
from planner.geometry.pose import FloatArray
from planner.message import Message

_PIECES_MAX = 64
"""Closed lines, the largest first, that may be pieces; what is smaller is taken as part of none."""


@dataclass(frozen=True, slots=True)
class Pieces:
    """The pieces of a drawing.

    Attributes:
        piece: the name of the one that was taken.
        pieces: the names of all of them, the largest first.
    """

    piece: str
    pieces: tuple[str, ...]


def in_pieces(rings: Sequence[FloatArray], blocks: Sequence[int | None]) -> list[list[int]]:
    """Return the closed lines of each piece: its outline, and what of the same block lies in it.

    Args:
        rings: closed lines, the largest first, shape (n, 2) each.
        blocks: the number of the block of each; pieces in several blocks may be drawn over each other.
    """
    pieces: list[list[int]] = []
    for number, ring in enumerate(rings[:_PIECES_MAX]):
        near = (piece for piece in pieces if blocks[piece[0]] == blocks[number])
        around = next((piece for piece in near if is_within(ring, rings[piece[0]])), None)
        if around is None:
            pieces.append([number])
        else:
            around.append(number)
    return pieces


def named_pieces(labels: Sequence[str | None]) -> tuple[str, ...]:
    """Return a name for each piece: its label, with a number where others have it too, or its number alone."""
    counts, used = Counter(labels), Counter[str]()
    names = []
    for number, label in enumerate(labels):
        used[label or ""] += 1
        if label is None:
            names.append(str(number + 1))
        else:
            names.append(label if counts[label] == 1 else f"{label} {used[label]}")
    return tuple(names)


def joined_name(one: str | None, other: str | None) -> str | None:
    """Return the name of two halves together; None if neither has one."""
    return " + ".join(sorted({name for name in (one, other) if name})) or None


def piece_wanted(names: Sequence[str], wanted: str | None) -> int:
    """Return which piece is wanted, by name in small or capital letters; the largest if none is.

    Raises:
        ImportedFileError: there is no such piece; the field is ``piece``.
    """
    if wanted is None:
        return 0
    plain = [name.casefold() for name in names]
    if wanted.strip().casefold() in plain:
        return plain.index(wanted.strip().casefold())
    text = f"expected one of {', '.join(names)}; got {wanted[:40]!r}"
    raise ImportedFileError("piece", Message("no_such_piece", text, {"piece": wanted[:40], "pieces": list(names)}))
