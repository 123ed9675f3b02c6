"""The fold lines that are still to be folded, drawn on the cloth where it lies."""

import numpy as np
import viser
from numpy.typing import NDArray

from app.ui.colours import LIGHT, Palette
from app.ui.dashes import dash_dot, solid, split_at
from app.ui.lighting import ink
from app.ui.relief import Relief
from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table_top import TableTop
from planner.plan.frame import ClothSurface

ROOT = "/folds"

_ABOVE_CLOTH_M = 0.003
_LINE_PX = 3.0
_CURRENT_PX = 5.0
_NOTHING = np.zeros((0, 2, 3))


class FoldView:
    """Blue lines solid, red ones dash-dot; nodes ``/folds/0``, ``/folds/1``, ... as in the garment."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Nothing is drawn before `show_garment`."""
        self._server = server
        self._palette = LIGHT
        self._folds: tuple[DrawnFold, ...] = ()
        self._lines: list[viser.LineSegmentsHandle] = []

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        self._palette = palette
        for line, fold in zip(self._lines, self._folds, strict=True):
            line.colors = self._colour(fold)

    def show_garment(self, garment: Garment) -> None:
        """Take the folds of another garment; `place` then says where they are."""
        before, self._folds = self._folds, garment.folds
        if [fold.is_red for fold in before] == [fold.is_red for fold in garment.folds]:
            return  # a fold that is being moved does not flicker
        for line in self._lines:
            line.remove()
        self._lines = [self._add_line(index, fold) for index, fold in enumerate(garment.folds)]

    def place(
        self, placement: Pose2, cloth: ClothSurface, top: TableTop, done: frozenset[int], current: int | None
    ) -> None:
        """Draw the folds that are not done on a cloth that lies on a top and hangs beside it."""
        relief = Relief.of(cloth, top)
        for index, (line, fold) in enumerate(zip(self._lines, self._folds, strict=True)):
            points = _in_space(fold, placement, relief, top) if index not in done else _NOTHING
            line.visible = len(points) > 0
            line.thickness = _CURRENT_PX if index == current else _LINE_PX
            if len(points) > 0:
                line.points = points.astype(np.float32)

    def _add_line(self, index: int, fold: DrawnFold) -> viser.LineSegmentsHandle:
        return self._server.scene.add_line_segments(
            f"{ROOT}/{index}",
            np.zeros((1, 2, 3)),
            self._colour(fold),
            thickness=_LINE_PX,
            thickness_units="screen",
            visible=False,
        )

    def _colour(self, fold: DrawnFold) -> NDArray[np.uint8]:
        return ink(self._palette.fold_red if fold.is_red else self._palette.fold_blue)


def _in_space(fold: DrawnFold, placement: Pose2, relief: Relief, top: TableTop) -> FloatArray:
    """The line in steps, shape (n, 2, 3), each as high as the highest cloth under it; none where no cloth lies."""
    cut = dash_dot if fold.is_red else solid
    drawn = cut(np.array(fold.start), np.array(fold.end)).reshape(-1, 2)
    steps = placement.to_outer(drawn).reshape(-1, 2, 2)
    for corner in (top.low, top.high):
        for axis, place in enumerate(corner):
            if np.isfinite(place):
                steps = split_at(steps, axis, place)
    asked = np.stack([steps[:, 0], steps.mean(axis=1), steps[:, 1]], axis=1)
    heights = relief.heights_at(asked.reshape(-1, 2)).reshape(-1, 3)
    is_on_cloth = np.isfinite(heights[:, 1])
    steps, gaps = steps[is_on_cloth], heights[is_on_cloth].max(axis=1) + _ABOVE_CLOTH_M
    unrolled = np.concatenate([steps, np.zeros((len(steps), 2, 1))], axis=2)
    for gap in np.unique(gaps):
        unrolled[gaps == gap] = top.over_edge(unrolled[gaps == gap], float(gap))
    return unrolled
