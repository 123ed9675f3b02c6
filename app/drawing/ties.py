"""Converts between ties, which refer to corners and folds by id, and attachments, which refer to them by index."""

from dataclasses import dataclass

import numpy as np

from app.drawing.drawing import CornerTie, CreaseTie, Drawing, EdgeTie, Tie
from planner.folds.attachment import Attachment, OnCrease, OnEdge, OnVertex
from planner.geometry.pose import Point2


@dataclass(frozen=True, slots=True)
class Names:
    """The ids of a drawing's corners and folds, in order.

    Attributes:
        corners: the corners' ids.
        points: the corners' positions (m).
        folds: the folds' ids.
        titles: the folds' displayed names.
    """

    corners: tuple[str, ...]
    points: tuple[Point2, ...]
    folds: tuple[str, ...]
    titles: tuple[str, ...]

    @staticmethod
    def of(drawing: Drawing) -> "Names":
        """Return the names in a drawing."""
        corners = tuple(corner.id for corner in drawing.outline)
        folds = drawing.folds
        return Names(corners, drawing.points, tuple(fold.id for fold in folds), tuple(fold.name for fold in folds))

    def attachment(self, tie: Tie | None) -> Attachment | None:
        """Return the attachment that a tie refers to; None without a tie, or if its target does not exist."""
        match tie:
            case CornerTie(corner) if corner in self.corners:
                return OnVertex(self.corners.index(corner))
            case EdgeTie(start, end, fraction) if start in self.corners and end in self.corners and start != end:
                return self._on_outline(self.corners.index(start), self.corners.index(end), fraction)
            case CreaseTie(fold, fraction, carried) if {fold, *carried} <= set(self.folds):
                return OnCrease(self.folds.index(fold), fraction, tuple(self.folds.index(one) for one in carried))
        return None

    def tie(self, attachment: Attachment) -> Tie:
        """Return the tie that refers to an attachment."""
        match attachment:
            case OnVertex(vertex):
                return CornerTie(self.corners[vertex])
            case OnEdge(edge, fraction):
                return EdgeTie(self.corners[edge], self.corners[(edge + 1) % len(self.corners)], fraction)
            case OnCrease(fold, fraction, carried):
                return CreaseTie(self.folds[fold], fraction, tuple(self.folds[one] for one in carried))

    def _on_outline(self, start: int, end: int, fraction: float) -> OnEdge:
        """Return the point at a fraction of the way along the outline, in the direction with fewer corners."""
        count = len(self.corners)
        if (end - start) % count > count // 2:
            start, end, fraction = end, start, 1.0 - fraction
        if (end - start) % count == 1:
            return OnEdge(start, fraction)
        walk = [(start + step) % count for step in range((end - start) % count + 1)]
        points = np.array([self.points[corner] for corner in walk])
        lengths = np.hypot(*np.diff(points, axis=0).T)
        ends = np.cumsum(lengths)
        place = fraction * ends[-1]
        leg = min(int(np.searchsorted(ends, place)), len(lengths) - 1)
        along = float((place - ends[leg] + lengths[leg]) / lengths[leg]) if lengths[leg] > 0.0 else 0.0
        return OnEdge(walk[leg], min(max(along, 0.0), 1.0))
