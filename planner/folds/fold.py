"""A legal fold: its line snapped to the silhouette, and its place in the sequence."""

from dataclasses import dataclass

import numpy as np

from planner.cloth.garment import DrawnFold
from planner.errors import FoldError
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M
from planner.message import Message


@dataclass(frozen=True, slots=True)
class Fold:
    """A legal fold of a sequence.

    Attributes:
        index: its place in the user's order.
        name: the user's name for it.
        is_red: whether it folds only the layers that the fold before it moved.
        line: the fold line in the article frame, ends on the silhouette's boundary; its left moves.
        grip_radius_m: the radius within which one grip holds the cloth (m).
    """

    index: int
    name: str
    is_red: bool
    line: Segment
    grip_radius_m: float


def snapped_line(drawn: DrawnFold, silhouette: Region) -> Segment:
    """Return the drawn line with its ends snapped to the silhouette's boundary.

    An end that is already there, within the tolerance, stays exactly where it was drawn, so snapping a line twice moves
    it only once.

    Raises:
        FoldError: an end is more than 5 mm from the boundary, both ends fall on one point, or the line
            does not run inside the silhouette.
    """
    ends = np.array([drawn.start, drawn.end])
    nearest = silhouette.nearest_boundary_points(ends)
    for name, end, foot in zip(("start", "end"), ends, nearest, strict=True):
        gap = float(np.hypot(*(foot - end)))
        if gap > SNAP_M:
            text = (
                f"({end[0]:.4f}, {end[1]:.4f}) m is {gap * 1000:.1f} mm from the silhouette's boundary, "
                f"at most {SNAP_M * 1000:g} mm are snapped"
            )
            values = {"at": [float(end[0]), float(end[1])], "off_m": gap, "most_m": SNAP_M}
            raise FoldError(name, Message("end_off_boundary", text, values))
        if gap <= LENGTH_M:
            foot[:] = end
    start, end = (_point(p) for p in nearest)
    if np.hypot(*(nearest[1] - nearest[0])) <= SNAP_M:
        raise FoldError("end", "both ends of the line snap to nearly the same point of the boundary")
    line = Segment(start, end)
    if not silhouette.contains_segment(line):
        raise FoldError("end", "the line between its ends leaves the silhouette")
    return line


def is_snapped(line: Segment, silhouette: Region) -> bool:
    """Return whether a line is snapped: its ends on the silhouette's boundary, and inside between them."""
    ends = (line.start, line.end)
    return all(silhouette.boundary_distance(end) <= LENGTH_M for end in ends) and silhouette.contains_segment(line)


def _point(row: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Point2:
    return (float(row[0]), float(row[1]))
