"""Converts between ties, which refer to corners and folds by id, and attachments, which refer to them by index."""

from dataclasses import dataclass

from app.drawing.drawing import CornerTie, CreaseTie, Drawing, EdgeTie, Tie
from app.drawing.ring import Ring, ring_of
from planner.folds.attachment import Attachment, OnCrease, OnEdge, OnVertex


@dataclass(frozen=True, slots=True)
class Names:
    """The ids of a drawing's corners and folds, in order.

    Attributes:
        corners: the corners' ids.
        ring: the polygon that stands for the outline.
        folds: the folds' ids.
        titles: the folds' displayed names.
    """

    corners: tuple[str, ...]
    ring: Ring
    folds: tuple[str, ...]
    titles: tuple[str, ...]

    @staticmethod
    def of(drawing: Drawing) -> "Names":
        """Return the names in a drawing."""
        corners = tuple(corner.id for corner in drawing.outline)
        folds = drawing.folds
        ring = ring_of(drawing.outline)
        return Names(corners, ring, tuple(fold.id for fold in folds), tuple(fold.name for fold in folds))

    def attachment(self, tie: Tie | None) -> Attachment | None:
        """Return the attachment that a tie refers to; None without a tie, or if its target does not exist."""
        match tie:
            case CornerTie(corner) if corner in self.corners:
                return OnVertex(self.ring.starts[self.corners.index(corner)])
            case EdgeTie(start, end, fraction) if start in self.corners and end in self.corners and start != end:
                return self._on_outline(self.corners.index(start), self.corners.index(end), fraction)
            case CreaseTie(fold, fraction, carried) if {fold, *carried} <= set(self.folds):
                return OnCrease(self.folds.index(fold), fraction, tuple(self.folds.index(one) for one in carried))
        return None

    def tie(self, attachment: Attachment) -> Tie:
        """Return the tie that refers to an attachment."""
        match attachment:
            case OnVertex(vertex):
                is_corner = self.ring.is_corner(vertex)
                return CornerTie(self.corners[self.ring.corner(vertex)]) if is_corner else self._edge_tie(vertex, 0.0)
            case OnEdge(edge, fraction):
                return self._edge_tie(edge, fraction)
            case OnCrease(fold, fraction, carried):
                return CreaseTie(self.folds[fold], fraction, tuple(self.folds[one] for one in carried))

    def is_current(self, tie: Tie) -> bool:
        """Return whether a tie is to a single edge, in the outline's direction, so that it needs no other form."""
        if not isinstance(tie, EdgeTie) or tie.start not in self.corners:
            return False
        return self.corners[(self.corners.index(tie.start) + 1) % len(self.corners)] == tie.end

    def _on_outline(self, start: int, end: int, fraction: float) -> OnEdge:
        """Return the point at a fraction of the way along the outline, in the direction with fewer corners."""
        count = len(self.corners)
        if (end - start) % count > count // 2:
            start, end, fraction = end, start, 1.0 - fraction
        return OnEdge(*self.ring.place(start, end, fraction))

    def _edge_tie(self, edge: int, along: float) -> EdgeTie:
        """Return the tie to a place of the ring: a piece of it, and how far along that."""
        first = self.ring.corner(edge)
        following = self.corners[(first + 1) % len(self.corners)]
        return EdgeTie(self.corners[first], following, self.ring.fraction(edge, along))
