"""Points of the cloth at one moment: in space, the triangles between them always the same."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from planner.cloth.layer import Layer, nearest_layers
from planner.folds.fold_path import FoldPath
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.drape import draped
from planner.geometry.pose import FloatArray
from planner.motion.cloth_surface import ClothMoment, placed


class ClothPoints:
    """Points of a garment's pattern, at any moment of a plan."""

    def __init__(self, sequence: FoldSequence, pattern: FloatArray) -> None:
        """Take points of the pattern, shape (n, 2), m."""
        self._sequence, self._pattern = sequence, pattern
        self._numbers: dict[tuple[int, int | None], NDArray[np.int64]] = {}

    def at(self, moment: ClothMoment) -> FloatArray:
        """Return where the points are, table frame, shape (n, 3), m; they lie in their layers as the surface does."""
        done, fold, sweep, placement, top, droop = moment
        layers: Sequence[Layer] = self._sequence.cloth(done).layers
        staying = len(layers)
        if fold is not None:
            folded = self._sequence.folded(done, fold)
            staying = len(folded.cloth.layers) - folded.cloth.moved
            layers = [*folded.cloth.layers[:staying], *folded.layers]
        if (numbers := self._numbers.get((done, fold))) is None:
            numbers = self._numbers[done, fold] = nearest_layers(layers, self._pattern)
        article = np.empty_like(self._pattern)
        for number, layer in enumerate(layers):
            article[numbers == number] = layer.isometry.apply(self._pattern[numbers == number])
        unrolled = np.column_stack([placement.to_outer(article), np.zeros(len(article))])
        heights = np.arange(len(layers))
        if fold is not None:
            line, moves = self._sequence.folds[fold].line, numbers >= staying
            path = FoldPath(
                placed(line, placement), float(line.left_distances(folded.moving.coordinates).max()), top, top
            )
            unrolled[moves] = path.swept(unrolled[moves, :2], sweep)
            heights[staying:] = heights[staying:][:: -1 if sweep > 1.0 else 1]
        return draped(
            top, unrolled, np.asarray((heights[numbers] + 1) * self._sequence.garment.layer_m, dtype=np.float64), droop
        )
