"""Fold a garment like another one: its folds, fitted to another outline.

Both garments are folded side by side. Before each fold the two silhouettes correspond: their bounds do, and so do
corners that point the same way and are nearest to each other in these bounds. A coordinate between those is
interpolated along its axis, so that lines along an axis stay so, and mirrored pairs stay pairs; halves, thirds and
quarters of a silhouette are those of the other one. A fold along a corner that points inwards folds in a flap: where
the other garment has no such flap, it is left out, as is what is not legal there.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import DrawnFold, Garment
from planner.errors import FieldError, FoldError, RequestError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import fold_cloth
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import SNAP_M
from planner.proposals.moves import is_inward, rounded
from planner.proposals.packet import Packet
from planner.proposals.target import Sides

_CORNER_SHARE, _FLAP_SHARE = 0.15, 0.25
"""How far apart corners may be that correspond, and those that point inwards, as shares of the bounds."""

_SLANT_RAD = 0.4
"""How far from an axis a line may turn that joins corners and ran along the axis."""

_PARTS, _PART_SHARE = (1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4), 0.01
"""The parts of a silhouette at which people fold, and how near to one a line along an axis counts as being there."""

_ALIKE = 0.15
"""Differences of likeness that do not count."""

_AXES = ((1, 0), (0, 1))
_WAYS = tuple(
    Isometry(sign * a, sign * flip * b, sign * c, sign * flip * d)
    for (a, b), (c, d) in (_AXES, _AXES[::-1])
    for sign in (1, -1)
    for flip in (1, -1)
)
"""The ways in which another garment may lie along the axes, as it is drawn first."""


class LikenessSearch:
    """The folds of another garment fitted to a garment, from each side that suits.

    Attributes:
        enumerated: the number of ways that were folded so far.
        nearest_m: the sides of the last packet (m).
    """

    def __init__(self, garment: Garment, model: Garment) -> None:
        """Prepare the search; raises `FoldError` if a fold of either is not legal."""
        if not model.folds:
            raise RequestError("to.like", f"{model.title!r:.80} has no folds")
        try:
            FoldSequence.of(model)
        except FoldError as error:
            raise error.within("to.like") from None
        self._garment, self._model = garment, model
        self._begin = Packet.of(garment)
        self.enumerated = 0
        self.nearest_m: Sides = self._begin.size_m

    def packets(self) -> Iterator[Packet]:
        """Yield the packets: with most of the folds first, then as the outlines are alike, as drawn before turned."""
        radius_m, pattern = self._garment.grip_radius_m, self._garment.pattern
        fitted: dict[tuple[DrawnFold, ...], tuple[int, float, ClothState]] = {}
        for way in _WAYS:
            self.enumerated += 1
            model = _laid(self._model, way)
            cloth, folds = _fitted(self._begin.cloth, model, radius_m)
            unlike = -_likeness(model.pattern, pattern) // _ALIKE
            fitted.setdefault(folds, (-len(folds), unlike, cloth))
        fitted.pop((), None)
        for folds, (*_, cloth) in sorted(fitted.items(), key=lambda one: one[1][:2]):
            packet = replace(self._begin, cloth=cloth, folds=(*self._begin.folds, *folds))
            self.nearest_m = packet.size_m
            yield packet


def _laid(model: Garment, way: Isometry) -> Garment:
    """Return a garment turned or mirrored in its plane; its folds move the same cloth."""
    folds = tuple(
        replace(
            fold,
            start=way.apply_point(fold.end if way.is_mirrored else fold.start),
            end=way.apply_point(fold.start if way.is_mirrored else fold.end),
        )
        for fold in model.folds
    )
    return replace(model, outline=tuple(way.apply_point(point) for point in model.outline), folds=folds)


def _likeness(one: Region, other: Region) -> float:
    """Return the share of what two outlines cover that both do, each brought to a square; less if they are longer."""
    first, second = (Region.polygon(_shares(region.ring, region)) for region in (one, other))
    slimness = [(x1 - x0) / (y1 - y0) for x0, y0, x1, y1 in (one.bounds, other.bounds)]
    return first.intersection(second).area / Region.union([first, second]).area * min(slimness) / max(slimness)


def _fitted(cloth: ClothState, model: Garment, grip_radius_m: float) -> tuple[ClothState, tuple[DrawnFold, ...]]:
    """Return a stack folded like a garment, and the folds that it takes."""
    folds: list[DrawnFold] = []
    line: Segment | None = None  # of the fold before; None if it was left out, and with it red folds that go on
    like, line_like = ClothState.spread_out(model.pattern), None
    corners = np.empty((0, 2, 2))
    for drawn in model.folds:
        rule = FOLD_KINDS[drawn.kind]
        before_like, line_like = line_like, snapped_line(drawn, rule.silhouette(like))
        before, line = line, None
        known = _Correspondence(rule.silhouette(like), rule.silhouette(cloth), corners)
        like = fold_cloth(like, line_like, drawn.kind, before_like if rule.is_red else None).cloth
        corners = known.corners
        if not (rule.is_red and before is None) and (found := known.line(line_like)) is not None:
            try:
                fold = _fold(drawn, found, rule.silhouette(cloth), grip_radius_m)
                snapped = snapped_line(fold, rule.silhouette(cloth))
                cloth = fold_cloth(cloth, snapped, fold.kind, before if rule.is_red else None).cloth
            except FieldError:
                continue
            line = snapped
            folds.append(fold)
    return cloth, tuple(folds)


def _fold(drawn: DrawnFold, line: Segment, silhouette: Region, grip_radius_m: float) -> DrawnFold:
    """Return a fold along the chord nearest to a line; raises `FoldError` without one."""
    chord = FOLD_KINDS[drawn.kind].nearest(silhouette, line) or line
    return DrawnFold(drawn.name, drawn.kind, rounded(chord.start), rounded(chord.end), grip_radius_m)


class _Correspondence:
    """What in one silhouette corresponds to what in another one.

    Attributes:
        corners: corners of the one and of the other, shape (n, 2, 2), m; those known from before come first.
    """

    def __init__(self, like: Region, silhouette: Region, corners: FloatArray) -> None:
        """Pair the corners, the nearest first, and with them coordinates along each axis that stay in order."""
        self._bounds = np.reshape([like.bounds, silhouette.bounds], (2, 2, 2))
        ring, other = like.main_shape, silhouette.main_shape
        inward = is_inward(ring)
        self._inward = ring[inward]
        gaps = np.hypot(*(_shares(ring, like)[:, None] - _shares(other, silhouette)[None]).transpose(2, 0, 1))
        gaps[inward[:, None] != is_inward(other)[None]] = np.inf
        nearest = gaps.argmin(axis=1)
        most = np.where(inward, _FLAP_SHARE, _CORNER_SHARE)
        pairs = [i for i, j in enumerate(nearest) if gaps[:, j].argmin() == i and gaps[i, j] <= most[i]]
        pairs.sort(key=lambda i: float(gaps[i, nearest[i]]))
        self.corners = np.vstack([corners, np.stack([ring[pairs], other[nearest[pairs]]], axis=1)])
        self._knots = [self._axis(axis, ring) for axis in (0, 1)]

    def _axis(self, axis: int, ring: FloatArray) -> FloatArray:
        """Return coordinates along an axis that correspond, ascending in both silhouettes, shape (n, 2), m."""
        knots = self._bounds[:, :, axis].T.tolist()
        for corner, there in self.corners:
            if _nearest(ring, corner) is not None:
                own, other = float(corner[axis]), float(there[axis])
                if all(abs(own - knot) > SNAP_M and (own - knot) * (other - its) > 0.0 for knot, its in knots):
                    knots.append([own, other])
        return np.array(sorted(knots))

    def line(self, line: Segment) -> Segment | None:
        """Return the line that corresponds to one; None if it folds in a flap that is not there."""
        ends = np.array([line.start, line.end])
        corners = [_nearest(self.corners[:, 0], end) for end in ends]
        there = np.array([
            [self._coordinate(axis, end[axis]) for axis in (0, 1)] if corner is None else self.corners[corner, 1]
            for end, corner in zip(ends, corners, strict=True)
        ])  # fmt: skip
        flaps = [_nearest(self._inward, end) is not None for end in ends]
        is_missing = any(flap and corner is None for flap, corner in zip(flaps, corners, strict=True))
        moved, turned = abs(ends[1] - ends[0]), abs(there[1] - there[0])
        across = int(moved.argmin())
        if moved[across] > SNAP_M:  # slanted
            if is_missing:
                return None
        elif corners == [None, None] and (part := self._part(across, ends[0, across], is_half=is_missing)) is not None:
            there[:, across] = part
        elif is_missing:
            return None
        elif None in corners or turned[across] > math.tan(_SLANT_RAD) * turned[1 - across]:
            is_flap = any(flaps)
            there[:, across] = (
                there[flaps.index(True), across] if is_flap else self._coordinate(across, ends[0, across])
            )
        (x0, y0), (x1, y1) = there.tolist()
        return Segment((x0, y0), (x1, y1)) if math.dist((x0, y0), (x1, y1)) > SNAP_M else None

    def _part(self, axis: int, value: float, *, is_half: bool) -> float | None:
        """Return where people fold a silhouette if a coordinate is such a part, or its half, of the other one (m)."""
        own, other = self._bounds[:, :, axis]
        share = (value - own[0]) / (own[1] - own[0])
        near = [part for part in ((1 / 2,) if is_half else _PARTS) if abs(share - part) <= _PART_SHARE]
        return float(other[0] + near[0] * (other[1] - other[0])) if near else None

    def _coordinate(self, axis: int, value: float) -> float:
        """Return the coordinate that corresponds to one (m)."""
        return float(np.interp(value, *self._knots[axis].T))


def _nearest(corners: FloatArray, end: FloatArray) -> int | None:
    """Return the index of the corner at which a line ends; None if it ends at none."""
    if not len(corners):
        return None
    gaps = np.hypot(*(corners - end).T)
    return int(gaps.argmin()) if gaps.min() <= SNAP_M else None


def _shares(points: FloatArray, region: Region) -> FloatArray:
    """Return points by their place within a region's bounds, 0 to 1 along each axis."""
    x0, y0, x1, y1 = region.bounds
    return np.asarray((points - np.array([x0, y0])) / np.array([x1 - x0, y1 - y0]))
