"""The positions of the cloth's points after a set of folds, as planned."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from planner.cloth.layer import Layer, nearest_layers
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import FloatArray, Pose2, point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from planner.geometry.tolerance import LENGTH_M


def planned_positions(
    sequence: FoldSequence, pattern: FloatArray, done: int, placement: Pose2, table: Table, gap_m: float
) -> FloatArray:
    """Return the planned positions of points of the cloth, table frame, shape (n, 3), m.

    Args:
        sequence: the garment's folds.
        pattern: the points in the pattern's frame, shape (n, 2), m.
        done: the folds done, as a bit mask.
        placement: the garment frame in the table frame.
        table: the table, beyond whose edges cloth hangs.
        gap_m: the height of a layer above the one below (m).
    """
    cloth = sequence.cloth(done)
    numbers = layer_numbers(sequence, pattern, done)
    folded = np.empty_like(pattern)
    for number in np.unique(numbers).tolist():
        folded[numbers == number] = cloth.layers[number].isometry.apply(pattern[numbers == number])
    unrolled = np.column_stack([placement.to_outer(folded), gap_m * (numbers + 0.5)])
    return TableTop.of(table).over_edge(unrolled)


def layer_numbers(sequence: FoldSequence, pattern: FloatArray, done: int) -> NDArray[np.int64]:
    """Return the layer to which each point belongs, 0 at the bottom, shape (n,)."""
    return nearest_layers(sequence.cloth(done).layers, pattern)


def creases(layer: Layer, pattern: Region) -> Iterator[Segment]:
    """Yield the edges of a layer at which the cloth continues in another layer, pattern's frame."""
    ring = layer.pattern_piece.whole_ring
    for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        if pattern.boundary_distance(point2((start + end) / 2.0)) > LENGTH_M:
            yield Segment(point2(start), point2(end))


def crease_distances(sequence: FoldSequence, pattern: FloatArray, done: int) -> FloatArray:
    """Return how far each point is from the nearest crease, pattern's frame, shape (n,), m; inf without creases.

    Args:
        sequence: the garment's folds.
        pattern: the points in the pattern's frame, shape (n, 2), m.
        done: the folds done, as a bit mask.
    """
    whole = sequence.garment.pattern
    nearest = np.full(len(pattern), np.inf)
    for layer in sequence.cloth(done).layers:
        for crease in creases(layer, whole):
            nearest = np.minimum(nearest, crease.distances(pattern))
    return nearest
