"""The kinds of folds. The set is open: what a kind does to the cloth is said here, and all else asks its kind."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from planner.cloth.cloth_state import ClothState
from planner.cloth.cut_line import is_cut, left_part, snapped_cut
from planner.cloth.layer import Layer
from planner.cloth.turn_line import is_turn, nearest_turn, snapped_turn, whole
from planner.geometry.chord import nearest_chord
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment

FoldName: TypeAlias = Literal["blue", "red", "turn"]
"""The names of all kinds, as garment files and REST have them."""


@dataclass(frozen=True, slots=True)
class FoldKind:
    """A kind of fold.

    Attributes:
        name: its name in garment files.
        is_red: whether it goes on with the layers that the fold before it moved, without letting go of them.
        snapped: returns the line between two drawn ends, snapped to a silhouette; raises `FoldError` if it is not
            legal there.
        is_snapped: whether a line is one that `snapped` leaves as it is.
        moving: returns the part of a silhouette that moves about a snapped line; raises `FoldError` if none can.
        nearest: returns the snapped line on a silhouette that a segment drawn anywhere means; None without one.
        is_whole: whether all layers move and none is cut, so that the line is an edge that must lie on the table.
    """

    name: FoldName
    is_red: bool
    snapped: Callable[[Point2, Point2, Region], Segment] = snapped_cut
    is_snapped: Callable[[Segment, Region], bool] = is_cut
    moving: Callable[[Region, Segment], Region] = left_part
    nearest: Callable[[Region, Segment], Segment | None] = nearest_chord
    is_whole: bool = False

    def layers(self, cloth: ClothState) -> tuple[Layer, ...]:
        """Return the layers of a stack that it may move, bottom to top."""
        return cloth.flap if self.is_red else cloth.layers

    def silhouette(self, cloth: ClothState) -> Region:
        """Return the silhouette of those layers."""
        return Region.union(layer.region for layer in cloth.flap) if self.is_red else cloth.silhouette


_ALL = (
    FoldKind("blue", is_red=False),
    FoldKind("red", is_red=True),
    FoldKind("turn", False, snapped_turn, is_turn, whole, nearest_turn, is_whole=True),
)

FOLD_KINDS: Mapping[str, FoldKind] = {kind.name: kind for kind in _ALL}
"""All kinds of folds by name."""
