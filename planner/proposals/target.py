"""The size to which a garment is to be folded."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from planner.errors import RequestError

TOLERANCE_M = 0.01
"""How much longer than a target's side a packet's may be (m)."""

SIDE_MIN_M, SIDE_MAX_M = 0.01, 10.0
"""The shortest and the longest side of a target (m)."""

Sides = tuple[float, float]
"""The sides of a rectangle along x and y of the garment frame, or in any order (m)."""


@dataclass(frozen=True, slots=True)
class Target:
    """A size that a packet must not exceed, either way round.

    Attributes:
        width: one side (m), or its share of the garment's width.
        length: the other side (m), or its share of the garment's length.
        is_share: whether the sides are shares of the garment as it lies at the beginning.
        is_roll: whether it asks for a roll instead, of whatever size.
        is_hung: whether it is to hang over a bar: the garment's shorter side is at most `width` (m), and of the longer
            one the share `length` is left.
    """

    width: float
    length: float
    is_share: bool = False
    is_roll: bool = False
    is_hung: bool = False

    @staticmethod
    def of(to: "str | Sequence[float] | Target") -> "Target":
        """Return the target that is meant: its name, its sides as text, as in 25x30cm or 0.25x0.30, or two sides (m).

        Raises:
            RequestError: it is neither, or a side is out of range.
        """
        if isinstance(to, Target):
            return to
        if isinstance(to, str):
            return PRESETS[to] if to in PRESETS else _read(to)
        if len(to) != 2:
            raise RequestError("to", f"expected two sides, got {len(to)}")
        for side_m in to:
            if not SIDE_MIN_M <= side_m <= SIDE_MAX_M:
                raise RequestError("to", f"a side of {side_m:g} m is not within {SIDE_MIN_M:g} to {SIDE_MAX_M:g} m")
        return Target(to[0], to[1])

    @property
    def is_smallest(self) -> bool:
        """Whether it asks for packets as small as possible."""
        return self.width == 0.0 and not self.is_roll

    def sides_of(self, size_m: Sides) -> Sides:
        """Return the target's sides for a garment of a size at the beginning (m)."""
        if self.is_hung:
            wide_m, long_m = min(self.width, *size_m), self.length * max(size_m)
            return (wide_m, long_m) if size_m[0] <= size_m[1] else (long_m, wide_m)
        return (self.width * size_m[0], self.length * size_m[1]) if self.is_share else (self.width, self.length)


PRESETS: Mapping[str, Target] = {
    "shelf": Target(0.25, 0.30),
    "drawer": Target(0.20, 0.25),
    "suitcase": Target(0.30, 0.40),
    "hanger": Target(0.40, 1 / 2, is_hung=True),
    "halves": Target(1 / 2, 1 / 2, is_share=True),
    "thirds": Target(1 / 3, 1 / 3, is_share=True),
    "roll": Target(0.0, 0.0, is_roll=True),
    "smallest": Target(0.0, 0.0),
}
"""The targets that have names."""

_NUMBER = r"(\d{1,6}(?:\.\d{1,9})?|\.\d{1,9})"
_SIZE = re.compile(rf"{_NUMBER}x{_NUMBER}(cm|m)?")


def _read(text: str) -> Target:
    match = _SIZE.fullmatch(text)
    if match is None:
        known = ", ".join(PRESETS)
        raise RequestError("to", f"expected a size, as in 25x30cm or 0.25x0.30, or one of {known}; got {text[:80]!r}")
    unit_m = 0.01 if match[3] == "cm" else 1.0
    return Target.of((float(match[1]) * unit_m, float(match[2]) * unit_m))


def is_fitting(size_m: Sides, target_m: Sides) -> bool:
    """Return whether a rectangle fits a target either way round, to the tolerance."""
    return all(small <= wide + TOLERANCE_M for small, wide in zip(sorted(size_m), sorted(target_m), strict=True))


def excess_m(size_m: Sides, target_m: Sides) -> float:
    """Return how much longer than a target's sides a rectangle's are in all, either way round (m)."""
    return sum(max(0.0, side - most) for side, most in zip(sorted(size_m), sorted(target_m), strict=True))


def is_filling(size_m: Sides, full_m: Sequence[float]) -> bool:
    """Return whether no side of a rectangle is shorter than half of that of another, to the tolerance."""
    return all(small >= wide / 2 - TOLERANCE_M for small, wide in zip(sorted(size_m), sorted(full_m), strict=True))
