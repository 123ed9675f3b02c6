"""Attach a fold's ends to the garment, so that they stay in place when the garment changes its shape.

A fold's ends lie on the boundary of the silhouette at the fold's turn. Kept as points they would leave it as soon as
somebody pulls at a corner. But every piece of that boundary is cloth: an edge of the pattern where some layer carried
it, or the crease of an earlier fold. Folding is a continuous map from the pattern to the plane, so a place of the
*pattern* determines a place in the folded cloth, whatever the shape. An end is attached to a corner or to a fraction of
an edge of the pattern, or to a fraction of an earlier crease in the layer that certain folds had carried.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.layer import Layer
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M


@dataclass(frozen=True, slots=True)
class OnVertex:
    """An attachment to a corner of the outline, by its index."""

    vertex: int


@dataclass(frozen=True, slots=True)
class OnEdge:
    """An attachment to the edge from corner `edge` to the next one, at a fraction of its length (0..1)."""

    edge: int
    fraction: float


@dataclass(frozen=True, slots=True)
class OnCrease:
    """An attachment to the line of an earlier fold, at a fraction of its length (0..1).

    Attributes:
        fold: the earlier fold's index.
        fraction: the fraction, from the line's start.
        carried: the folds before that one which had moved the attached layer, ascending; the crease runs through
            several layers.
    """

    fold: int
    fraction: float
    carried: tuple[int, ...] = ()


Attachment: TypeAlias = OnVertex | OnEdge | OnCrease
"""The part of the garment that a fold's end is attached to."""


@dataclass(frozen=True, slots=True)
class Replay:
    """The folds done so far, in the user's order.

    Attributes:
        outline: the pattern's corners (m).
        cloths: the stack before each fold, and after the last.
        lines: the fold lines, garment frame.
    """

    outline: tuple[Point2, ...]
    cloths: tuple[ClothState, ...]
    lines: tuple[Segment, ...] = ()

    def then(self, line: Segment, cloth: ClothState) -> "Replay":
        """Return the replay with one more fold."""
        return Replay(self.outline, (*self.cloths, cloth), (*self.lines, line))

    def seen(self, kind: str) -> tuple[Layer, ...]:
        """Return the layers that a next fold of a kind may move."""
        return FOLD_KINDS[kind].layers(self.cloths[-1])


def place_of(attachment: Attachment, replay: Replay, kind: str) -> Point2 | None:
    """Return the place of an attachment after the folds so far, garment frame (m).

    Args:
        attachment: the attachment.
        replay: the folds so far.
        kind: the kind of the fold whose line it is for: a red one sees only the layers moved last.

    Returns:
        The place; None if there is no such corner, edge or crease, or not in the layers seen.
    """
    material = _material(attachment, replay)
    if material is None:
        return None
    layers = replay.seen(kind)
    gaps_m = Region.gaps([layer.pattern_piece for layer in layers], material)
    nearest = int(np.argmin(gaps_m)) if len(layers) else 0
    return layers[nearest].isometry.apply_point(material) if (gaps_m < SNAP_M).any() else None


def attached(place: Point2, replay: Replay, kind: str) -> Attachment | None:
    """Return the attachment for a place on the boundary of the silhouette.

    A corner is preferred to the end of a crease, that to an edge, and an edge to the inside of a crease; of layers that
    lie alike, the one moved least often is preferred.

    Args:
        place: garment frame, after the folds so far (m).
        replay: the folds so far.
        kind: the kind of the fold whose line it is for.

    Returns:
        The attachment; None if no layer seen has its boundary there.
    """
    found: list[tuple[int, int, Attachment]] = []
    for layer in replay.seen(kind):
        if layer.region.boundary_distance(place) <= LENGTH_M:
            trace = _Trace(layer, replay)
            material = layer.to_pattern(place)
            for rank, attachment in (*_on_outline(material, replay.outline), *trace.creases(material)):
                found.append((rank, len(trace.carried), attachment))
    return min(found, key=lambda one: one[:2])[2] if found else None


class _Trace:
    """The history of one layer through the folds so far."""

    def __init__(self, layer: Layer, replay: Replay) -> None:
        self._lines = replay.lines
        inner = layer.pattern_piece.inner_point
        self._stages = [_holding(inner, cloth.layers) for cloth in replay.cloths]
        faces = [stage.isometry.is_mirrored for stage in self._stages]
        self.carried = tuple(i for i in range(len(replay.lines)) if faces[i] != faces[i + 1])

    def creases(self, material: Point2) -> Iterator[tuple[int, OnCrease]]:
        """Yield the creases through a place of the pattern in this layer, ranked: 1 for an end, 3 inside."""
        for fold, (line, stage) in enumerate(zip(self._lines, self._stages, strict=False)):
            place = np.array([stage.isometry.apply_point(material)])
            if line.distances(place)[0] > LENGTH_M:
                continue
            fraction = min(max(float(line.positions(place)[0]) / line.length, 0.0), 1.0)
            carried = tuple(i for i in self.carried if i < fold)
            end = round(fraction)
            is_end = abs(fraction - end) * line.length <= LENGTH_M
            yield (1, OnCrease(fold, float(end), carried)) if is_end else (3, OnCrease(fold, fraction, carried))


def _holding(inner: Point2, layers: Sequence[Layer]) -> Layer:
    """Return the layer whose piece of the pattern contains a point."""
    return next(layer for layer in layers if layer.pattern_piece.contains(inner))


def _on_outline(material: Point2, outline: tuple[Point2, ...]) -> Iterator[tuple[int, Attachment]]:
    """Yield the corners and edges of the outline at a place of the pattern, each with its rank."""
    place = np.array([material])
    for index, corner in enumerate(outline):
        edge = Segment(corner, outline[(index + 1) % len(outline)])
        if np.hypot(*(place[0] - corner)) <= LENGTH_M:
            yield 0, OnVertex(index)
        elif edge.distances(place)[0] <= LENGTH_M:
            yield 2, OnEdge(index, float(edge.positions(place)[0]) / edge.length)


def _material(attachment: Attachment, replay: Replay) -> Point2 | None:
    """Return the place of the pattern that an attachment refers to (m); None if there is none."""
    match attachment:
        case OnVertex(vertex):
            return replay.outline[vertex] if vertex < len(replay.outline) else None
        case OnEdge(edge, fraction):
            if edge >= len(replay.outline):
                return None
            (ax, ay), (bx, by) = replay.outline[edge], replay.outline[(edge + 1) % len(replay.outline)]
            return (ax + fraction * (bx - ax), ay + fraction * (by - ay))
        case OnCrease(fold, fraction, carried):
            if fold >= len(replay.lines) or any(index >= fold for index in carried):
                return None
            line = replay.lines[fold]
            way = Isometry()
            for index in carried:
                way = Isometry.reflection(replay.lines[index]).after(way)
            return way.inverse.apply_point(line.at(fraction * line.length))
