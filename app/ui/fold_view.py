"""The fold lines that are still to be folded, drawn on the cloth."""

import numpy as np
import viser

from app.ui.colours import Palette
from app.ui.dashes import dash_dot, solid
from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.table_top import TableTop

ROOT = "/folds"

_ABOVE_CLOTH_M = 0.003
_LINE_PX = 3.0
_CURRENT_PX = 5.0


class FoldView:
    """Blue lines solid, red ones dash-dot; nodes ``/folds/0``, ``/folds/1``, ... as in the garment."""

    def __init__(self, server: viser.ViserServer, table: Table, palette: Palette) -> None:
        """Nothing is drawn before `show_garment`."""
        self._server = server
        self._top = TableTop.of(table)
        self._palette = palette
        self._garment: Garment | None = None
        self._lines: list[viser.LineSegmentsHandle] = []

    def show_garment(self, garment: Garment) -> None:
        """Take the folds of another garment; `place` then says where they are."""
        for line in self._lines:
            line.remove()
        self._garment = garment
        self._lines = [self._add_line(index, fold) for index, fold in enumerate(garment.folds)]

    def place(self, placement: Pose2, height_m: float, done: frozenset[int], current: int | None) -> None:
        """Draw the folds that are not done on cloth whose top is `height_m` over the table."""
        if self._garment is None:
            return
        for index, (line, fold) in enumerate(zip(self._lines, self._garment.folds, strict=True)):
            line.visible = index not in done
            line.thickness = _CURRENT_PX if index == current else _LINE_PX
            line.points = self._in_space(fold, placement, height_m + _ABOVE_CLOTH_M).astype(np.float32)

    def _add_line(self, index: int, fold: DrawnFold) -> viser.LineSegmentsHandle:
        return self._server.scene.add_line_segments(
            f"{ROOT}/{index}",
            np.zeros((1, 2, 3)),
            self._palette.fold_red if fold.is_red else self._palette.fold_blue,
            thickness=_LINE_PX,
            thickness_units="screen",
            visible=False,
        )

    def _in_space(self, fold: DrawnFold, placement: Pose2, height_m: float) -> FloatArray:
        cut = dash_dot if fold.is_red else solid
        flat = placement.to_outer(cut(np.array(fold.start), np.array(fold.end))).reshape(-1, 2)
        unrolled = np.column_stack([flat, np.zeros(len(flat))])
        return self._top.over_edge(unrolled, height_m).reshape(-1, 2, 3)
