"""A legal fold: its line snapped to the silhouette, and its place in the sequence."""

from dataclasses import dataclass

from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import DrawnFold
from planner.geometry.region import Region
from planner.geometry.segment import Segment


@dataclass(frozen=True, slots=True)
class Fold:
    """A legal fold of a sequence.

    Attributes:
        index: its place in the user's order.
        name: the user's name for it.
        kind: its kind, by name.
        line: the fold line in the garment frame, ends on the silhouette's boundary; its left moves.
        grip_radius_m: the radius within which one grip holds the cloth (m).
    """

    index: int
    name: str
    kind: str
    line: Segment
    grip_radius_m: float

    @property
    def is_red(self) -> bool:
        """Whether it folds only the layers that the fold before it moved."""
        return FOLD_KINDS[self.kind].is_red


def snapped_line(drawn: DrawnFold, silhouette: Region) -> Segment:
    """Return the drawn line snapped to the silhouette, as its kind asks for; raise `FoldError` if it cannot be."""
    return FOLD_KINDS[drawn.kind].snapped(drawn.start, drawn.end, silhouette)
