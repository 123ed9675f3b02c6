"""Lines that cut the cloth: where their ends may lie, and which part of the cloth is to their left."""

import numpy as np

from planner.errors import FoldError
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import split_along
from planner.geometry.tolerance import LENGTH_M, SNAP_M
from planner.message import Message


def snapped_cut(start: Point2, end: Point2, silhouette: Region) -> Segment:
    """Return a line with its ends snapped to the silhouette's boundary.

    An end that is already there, within the tolerance, stays exactly where it was drawn, so snapping a line twice moves
    it only once.

    Raises:
        FoldError: an end is more than 5 mm from the boundary, both ends fall on one point, or the line
            does not run inside the silhouette.
    """
    ends = np.array([start, end])
    nearest = silhouette.nearest_boundary_points(ends)
    for name, drawn, foot in zip(("start", "end"), ends, nearest, strict=True):
        gap = float(np.hypot(*(foot - drawn)))
        if gap > SNAP_M:
            text = (
                f"({drawn[0]:.4f}, {drawn[1]:.4f}) m is {gap * 1000:.1f} mm from the silhouette's boundary, "
                f"at most {SNAP_M * 1000:g} mm are snapped"
            )
            values = {"at": [float(drawn[0]), float(drawn[1])], "off_m": gap, "most_m": SNAP_M}
            raise FoldError(name, Message("end_off_boundary", text, values))
        if gap <= LENGTH_M:
            foot[:] = drawn
    (ax, ay), (bx, by) = nearest.tolist()
    if np.hypot(bx - ax, by - ay) <= SNAP_M:
        raise FoldError("end", "both ends of the line snap to nearly the same point of the boundary")
    line = Segment((ax, ay), (bx, by))
    if not silhouette.contains_segment(line):
        raise FoldError("end", "the line between its ends leaves the silhouette")
    return line


def is_cut(line: Segment, silhouette: Region) -> bool:
    """Return whether a line is snapped: its ends on the silhouette's boundary, and inside between them."""
    ends = (line.start, line.end)
    return all(silhouette.boundary_distance(end) <= LENGTH_M for end in ends) and silhouette.contains_segment(line)


def left_part(silhouette: Region, line: Segment) -> Region:
    """Return the part of a silhouette to the left of a snapped line.

    Raises:
        FoldError: no cloth lies to the left or to the right of the line, or the line does not part the cloth.
    """
    parts = split_along(silhouette, line)
    if parts is None:
        raise FoldError("end", "the line must cut the cloth completely: the parts are joined around one of its ends")
    moving, staying = parts
    require_both(not moving.is_sliver, not staying.is_sliver)
    return moving


def require_both(is_any_moving: bool, is_any_staying: bool) -> None:
    """Raise `FoldError` unless cloth lies on both sides of the line."""
    if not is_any_moving:
        raise FoldError("start", "no cloth lies to the left of the line, so nothing would move")
    if not is_any_staying:
        raise FoldError("start", "all the cloth lies to the left of the line, so nothing would stay")
