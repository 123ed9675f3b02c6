"""The positions of the cloth's points after a set of folds, as planned."""

import numpy as np
from numpy.typing import NDArray

from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.table_top import TableTop


def planned_positions(
    sequence: FoldSequence, pattern: FloatArray, done: int, placement: Pose2, table: Table, gap_m: float
) -> FloatArray:
    """Return the planned positions of points of the cloth, table frame, shape (n, 3), m.

    Args:
        sequence: the garment's folds.
        pattern: the points in the pattern's frame, shape (n, 2), m.
        done: the folds done, as a bit mask.
        placement: the article frame in the table frame.
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
    layers = sequence.cloth(done).layers
    return np.asarray(np.argmin([layer.pattern_piece.distances_to(pattern) for layer in layers], axis=0))
