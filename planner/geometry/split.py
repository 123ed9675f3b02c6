"""Cut a region along a segment only, not along the whole line through it.

Cutting along the whole line would also cut whatever the line's extension crosses: folding one sleeve would fold the
other. So the region is cut along the whole line, and pieces that touch across the line's extension are joined again.
Pieces that are still apart were separated by the segment.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

Interval = tuple[float, float]
"""A part of a line, from one position to another (m)."""


@dataclass(frozen=True, slots=True)
class Cut:
    """The result of cutting a connected region.

    Attributes:
        moving: the pieces in the part that moves.
        staying: the other pieces.
        slivers: parts too small to be pieces of cloth.
    """

    moving: tuple[Region, ...]
    staying: tuple[Region, ...]
    slivers: tuple[Region, ...] = ()


@dataclass(slots=True)
class _Piece:
    """A connected piece on one side of the line, and where it touches the line."""

    region: Region
    is_left: bool
    contacts: list[Interval]
    group: int = field(default=-1)

    def touches(self, low: float, high: float) -> bool:
        return any(_overlap(c, (low, high)) > LENGTH_M for c in self.contacts)


def split_along(region: Region, segment: Segment) -> tuple[Region, Region] | None:
    """Cut a region along a segment.

    Args:
        region: the region to cut.
        segment: the cut; its ends are expected on the region's boundary.

    Returns:
        The part joined to the segment's left side, and everything else, either of which may be empty. None if the
            segment
        does not separate them: they still hang together around one of its ends.
    """
    segment = _through_corners(region, segment)
    left_side, right_side = region.parted_by(segment)
    pieces = _pieces(left_side.pieces, segment, is_left=True) + _pieces(right_side.pieces, segment, is_left=False)
    _join_across_extension(pieces, region, segment)
    moving = {p.group for p in pieces if p.is_left and p.touches(0.0, segment.length)}
    if any(not p.is_left and p.group in moving and p.touches(0.0, segment.length) for p in pieces):
        return None
    left = [p for p in pieces if p.group in moving]
    right = [p.region for p in pieces if p.group not in moving]
    tips = _pieces(left_side.slivers, segment, is_left=True) + _pieces(right_side.slivers, segment, is_left=False)
    tips = [tip for tip in tips if _hangs_on(left, tip, region, segment)]
    return _union([p.region for p in left + tips]), _union(right)


def cut_like(region: Region, segment: Segment, is_moving: Callable[[Point2], bool]) -> Cut:
    """Make a cut through a region that lies within the one that was split.

    Args:
        region: the region to cut.
        segment: the cut, in the frame of `region`.
        is_moving: tells whether a point of `region` is in the part that moves.
    """
    distances = segment.left_distances(region.coordinates)
    if np.all(distances >= -LENGTH_M) or np.all(distances <= LENGTH_M):
        return Cut((region,), ()) if is_moving(region.inner_point) else Cut((), (region,))
    left, right = region.parted_by(_through_corners(region, segment))
    parts = [(part, is_moving(part.inner_point)) for part in left.parts + right.parts]
    moving = Region.rejoined(part for part, moves in parts if moves)
    staying = Region.rejoined(part for part, moves in parts if not moves)
    if not (moving.pieces and staying.pieces):
        return Cut((region,), ()) if moving.pieces else Cut((), (region,))
    return Cut(moving.pieces, staying.pieces, moving.slivers + staying.slivers)


def _through_corners(region: Region, segment: Segment) -> Segment:
    """Return the segment with its ends snapped to nearby corners of the region, so that a cut leaves no neck."""
    return Segment(_corner_at(region, segment.start), _corner_at(region, segment.end))


def _corner_at(region: Region, point: Point2) -> Point2:
    """Return the region's corner at a point; the point itself if no corner is there."""
    gaps = np.hypot(*(region.coordinates - point).T)
    nearest = int(np.argmin(gaps))
    x, y = region.coordinates[nearest]
    return (float(x), float(y)) if gaps[nearest] <= LENGTH_M else point


def _union(regions: list[Region]) -> Region:
    return Region.union(regions) if regions else Region.empty()


def _pieces(parts: Iterable[Region], segment: Segment, *, is_left: bool) -> list[_Piece]:
    return [_Piece(p, is_left, _contacts(p, segment)) for p in parts]


def _hangs_on(pieces: list[_Piece], sliver: _Piece, region: Region, segment: Segment) -> bool:
    """Return whether a sliver is the tip of pieces on the other side that cross the line's extension."""
    if sliver.touches(0.0, segment.length):
        return False
    return any(_share_extension(p, sliver, region, segment) for p in pieces if p.is_left != sliver.is_left)


def _contacts(piece: Region, segment: Segment) -> list[Interval]:
    """Return where edges of a piece lie on the line, as intervals from the segment's start (m)."""
    points = piece.coordinates
    on_line = np.abs(segment.left_distances(points)) <= LENGTH_M
    along = segment.positions(points)
    both = on_line[:-1] & on_line[1:]
    return [(min(a, b), max(a, b)) for a, b in zip(along[:-1][both], along[1:][both], strict=True)]


def _overlap(a: Interval, b: Interval) -> float:
    return min(a[1], b[1]) - max(a[0], b[0])


def _join_across_extension(pieces: list[_Piece], region: Region, segment: Segment) -> None:
    """Put pieces that touch across the line, outside the segment, into one group."""
    for number, piece in enumerate(pieces):
        piece.group = number
    for one in (p for p in pieces if p.is_left):
        for other in (p for p in pieces if not p.is_left):
            if one.group != other.group and _share_extension(one, other, region, segment):
                old, new = other.group, one.group
                for piece in pieces:
                    piece.group = new if piece.group == old else piece.group


def _share_extension(one: _Piece, other: _Piece, region: Region, segment: Segment) -> bool:
    """Return whether two pieces touch along the line before the segment's start or beyond its end.

    A segment that meets the boundary at a sharp angle may end slightly before it. Pieces that touch only that close to
    the boundary count as separated.
    """
    for a in one.contacts:
        for b in other.contacts:
            low, high = max(a[0], b[0]), min(a[1], b[1])
            for start, end in ((low, min(high, 0.0)), (max(low, segment.length), high)):
                if end - start > LENGTH_M and region.runs_inside(Segment(segment.at(start), segment.at(end))):
                    return True
    return False
