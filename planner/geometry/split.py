"""Cutting a region along a segment only, not along the whole line through it.

The naive cut with the whole line also cuts whatever the line's extension crosses: folding one sleeve
would fold the other. So the region is cut with the whole line, and pieces that touch across the line's
extension are joined again; what is still apart afterwards was parted by the segment.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

Interval = tuple[float, float]


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
    """What a cut along a segment leaves on its left and on its right.

    Args:
        region: what is cut.
        segment: the cut; its ends are expected on the region's boundary.

    Returns:
        The part joined to the segment's left side, and everything else; or None if the segment does
        not part them: they still hang together round one of its ends. Either may be empty.
    """
    pieces = _pieces(region, segment, is_left=True) + _pieces(region, segment, is_left=False)
    _join_across_extension(pieces, segment.length)
    moving = {p.group for p in pieces if p.is_left and p.touches(0.0, segment.length)}
    if any(not p.is_left and p.group in moving and p.touches(0.0, segment.length) for p in pieces):
        return None
    left = [p.region for p in pieces if p.group in moving]
    right = [p.region for p in pieces if p.group not in moving]
    return _union(left), _union(right)


def cut_like(
    region: Region, segment: Segment, is_moving: Callable[[Point2], bool]
) -> tuple[tuple[Region, ...], tuple[Region, ...]]:
    """The same cut through a region that lies within the one that was split.

    Args:
        region: what is cut.
        segment: the cut, in the frame of `region`.
        is_moving: whether a point of `region` is in the part that moves.

    Returns:
        The pieces that move and those that stay.
    """
    distances = segment.left_distances(region.coordinates)
    if np.all(distances >= -LENGTH_M) or np.all(distances <= LENGTH_M):
        return ((region,), ()) if is_moving(region.inner_point) else ((), (region,))
    pieces = region.left_of(segment).pieces + region.left_of(segment.reversed).pieces
    moving = [p for p in pieces if is_moving(p.inner_point)]
    staying = [p for p in pieces if not is_moving(p.inner_point)]
    if not (moving and staying):
        return ((region,), ()) if moving else ((), (region,))
    return _union(moving).pieces, _union(staying).pieces


def _union(regions: list[Region]) -> Region:
    return Region.union(regions) if regions else Region.empty()


def _pieces(region: Region, segment: Segment, *, is_left: bool) -> list[_Piece]:
    half = region.left_of(segment if is_left else segment.reversed)
    return [_Piece(p, is_left, _contacts(p, segment)) for p in half.pieces]


def _contacts(piece: Region, segment: Segment) -> list[Interval]:
    """Where edges of a piece lie on the line, as intervals from the segment's start (m)."""
    points = piece.coordinates
    on_line = np.abs(segment.left_distances(points)) <= LENGTH_M
    along = segment.positions(points)
    both = on_line[:-1] & on_line[1:]
    return [(min(a, b), max(a, b)) for a, b in zip(along[:-1][both], along[1:][both], strict=True)]


def _overlap(a: Interval, b: Interval) -> float:
    return min(a[1], b[1]) - max(a[0], b[0])


def _join_across_extension(pieces: list[_Piece], length: float) -> None:
    """Give pieces that touch across the line, outside the segment, the same group."""
    for number, piece in enumerate(pieces):
        piece.group = number
    for one in (p for p in pieces if p.is_left):
        for other in (p for p in pieces if not p.is_left):
            if one.group != other.group and _share_extension(one, other, length):
                old, new = other.group, one.group
                for piece in pieces:
                    piece.group = new if piece.group == old else piece.group


def _share_extension(one: _Piece, other: _Piece, length: float) -> bool:
    """Whether two pieces touch along the line before the segment's start or beyond its end."""
    for a in one.contacts:
        for b in other.contacts:
            low, high = max(a[0], b[0]), min(a[1], b[1])
            if min(high, 0.0) - low > LENGTH_M or high - max(low, length) > LENGTH_M:
                return True
    return False
