"""Roll up a garment: folds of one width, one after the other in one direction, so that each takes the roll along.

Flaps or sides may be folded in first, so that the roll is a full rectangle. A short roll about as wide as a hand comes
first; each number of turns along each axis is a way of its own.
"""

from collections.abc import Iterator
from typing import NamedTuple

from planner.cloth.garment import Garment
from planner.proposals.moves import Move, flap_moves, inward_moves, roll_moves
from planner.proposals.packet import FOLD_EFFORT, Packet
from planner.proposals.target import Sides

_WIDE_M, _WIDE_EFFORT_PER_M = 0.1, 10.0
"""How wide a roll is that people like (m), and the effort of one that is wider or narrower."""

_LONG_EFFORT_PER_M, _HOLLOW_EFFORT = 2.0, 4.0
"""The efforts of a long roll, and of one of cloth that covers nothing of its rectangle."""


class _Roll(NamedTuple):
    """A way to roll that was not folded yet: how much effort it is, a garment and the move."""

    effort: float
    begun: Packet
    move: Move


class RollSearch:
    """The ways to roll a garment up.

    Attributes:
        enumerated: the number of ways that were folded so far.
        nearest_m: the sides of the last packet (m).
    """

    def __init__(self, garment: Garment, max_folds: int) -> None:
        """Prepare the search; raises `FoldError` if a fold that the garment has is not legal."""
        self._begin = Packet.of(garment)
        self._radius_m, self._max_folds = garment.grip_radius_m, max_folds
        self.enumerated = 0
        self.nearest_m: Sides = self._begin.size_m

    def packets(self) -> Iterator[Packet]:
        """Yield the packets, those that people like first."""
        for _, begun, move in sorted(self._rolls(), key=lambda roll: roll.effort):
            self.enumerated += 1
            packet = begun.after(move, self._radius_m)
            if packet is not None and len(packet.folds) <= self._max_folds:
                self.nearest_m = packet.size_m
                yield packet

    def _rolls(self) -> Iterator[_Roll]:
        for begun in self._begun():
            for width_m, move in roll_moves(begun.cloth.silhouette.bounds):
                folds = len(begun.folds) + len(move.creases)
                if folds <= self._max_folds:
                    long = _LONG_EFFORT_PER_M * max(move.size_m) + _HOLLOW_EFFORT * begun.hollow
                    wide = _WIDE_EFFORT_PER_M * abs(width_m - _WIDE_M)
                    yield _Roll(move.effort + FOLD_EFFORT * folds + long + wide, begun, move)

    def _begun(self) -> Iterator[Packet]:
        """Yield the garment as it is, and with its flaps or its sides in."""
        silhouette = self._begin.cloth.silhouette
        yield self._begin
        sides = (side / 2.0 for side in self._begin.size_m)
        for move in (*flap_moves(silhouette), *inward_moves(silhouette.bounds, sides)):
            if move.kind in ("flaps", "sides") and (after := self._begin.after(move, self._radius_m)) is not None:
                yield after
