"""The remaining fold lines, drawn on the cloth where it lies; dashes tell kinds apart without colour, too."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle

import numpy as np
import viser
from numpy.typing import NDArray

from app.fold_looks import FOLD_LOOKS
from app.ui.colours import LIGHT, Palette
from app.ui.lighting import ink
from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.drape import bent_at, draped
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import TableTop
from planner.geometry.tolerance import LENGTH_M
from planner.motion.cloth_surface import ClothSurface

ROOT = "/folds"

_ABOVE_CLOTH_M = 0.003
_STEP_M = 0.01
_LINE_PX = 3.0
_CURRENT_PX = 5.0
_NOTHING = np.zeros((0, 2, 3))

_Seen = tuple[Pose2, ClothSurface, TableTop, frozenset[int], int | None]
"""The inputs of the lines: the garment's placement, its cloth, the top; the folds done and the fold under way."""

_ROUND_M = 1e-3  # cloth counts up to this far beyond its edge, as fold lines run along edges of folded cloth


@dataclass(frozen=True, slots=True)
class Relief:
    """The height of lying cloth under a point: drawings on the cloth follow its steps from layer to layer.

    It depends on one moment's surface alone, so it does not matter how the moment was reached. Hanging cloth has its
    place in the unrolled plane; cloth that stands or is in the air is left out.

    Attributes:
        triangles: in the unrolled plane, table frame, counter-clockwise, shape (n, 3, 2), m.
        heights: each triangle's height over the table (m), shape (n,).
    """

    triangles: FloatArray
    heights: FloatArray

    @staticmethod
    def of(cloth: ClothSurface) -> "Relief":
        """Return the relief of a surface."""
        unrolled = cloth.unrolled[cloth.triangles]
        lying = unrolled[~np.isnan(unrolled).any(axis=(1, 2))]
        flat = lying[..., :2].copy()
        sides = flat[:, 1:] - flat[:, :1]
        is_turned = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0] < 0.0
        flat[is_turned] = flat[is_turned, ::-1]
        return Relief(flat, lying[..., 2].max(axis=1, initial=0.0))

    def heights_at(self, points: FloatArray) -> FloatArray:
        """Return the height (m) of the topmost cloth under points of the unrolled plane, shape (n, 2) -> (n,).

        -inf where no cloth lies.
        """
        if not len(self.triangles):
            return np.full(len(points), -np.inf)
        sides = np.roll(self.triangles, -1, axis=1) - self.triangles
        lengths = np.maximum(np.hypot(sides[..., 0], sides[..., 1]), LENGTH_M)
        inwards = np.stack([-sides[..., 1], sides[..., 0]], axis=-1) / lengths[..., None]
        offsets = (inwards * self.triangles).sum(axis=-1)
        is_over = np.ones((len(points), len(self.triangles)), dtype=np.bool_)
        for side in range(3):
            is_over &= points @ inwards[:, side].T >= offsets[:, side] - _ROUND_M
        return np.asarray(np.where(is_over, self.heights, -np.inf).max(axis=1))


class FoldView:
    """Each kind in its colour and dashes; nodes ``/folds/0``, ``/folds/1``, ... as in the garment."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Take the server; nothing is drawn before `show_garment`."""
        self._server = server
        self._palette = LIGHT
        self._folds: tuple[DrawnFold, ...] = ()
        self._lines: list[viser.LineSegmentsHandle] = []
        self._seen: _Seen | None = None
        self._steps: list[FloatArray] = []

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        self._palette = palette
        for line, fold in zip(self._lines, self._folds, strict=True):
            line.colors = self._colour(fold)

    def show_garment(self, garment: Garment) -> None:
        """Take the folds of another garment; `place` then draws them."""
        before, self._folds, self._seen = self._folds, garment.folds, None
        if [fold.kind for fold in before] == [fold.kind for fold in garment.folds]:
            return  # a fold that is being moved does not flicker
        for line in self._lines:
            line.remove()
        self._lines = [self._add_line(index, fold) for index, fold in enumerate(garment.folds)]

    def clear(self) -> None:
        """Remove all folds, when there is no garment."""
        for line in self._lines:
            line.remove()
        self._folds, self._lines, self._seen = (), [], None

    def place(
        self, placement: Pose2, cloth: ClothSurface, top: TableTop, done: frozenset[int], current: int | None
    ) -> None:
        """Draw the remaining folds on cloth that lies on a table top and hangs over its edges."""
        seen = (placement, cloth, top, done, current)
        if seen == self._seen:
            return
        if self._seen is None or (placement, top) != (self._seen[0], self._seen[2]):
            self._steps = [_steps(fold, placement, top) for fold in self._folds]
        self._seen = seen
        waiting = [index for index in range(len(self._folds)) if index not in done]
        drawn = dict(zip(waiting, _in_space([self._steps[index] for index in waiting], cloth, top), strict=True))
        for index, line in enumerate(self._lines):
            points = drawn.get(index, _NOTHING)
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
        return ink(self._palette.folds[fold.kind])


def _steps(fold: DrawnFold, placement: Pose2, top: TableTop) -> FloatArray:
    """Return the line in steps in the unrolled plane, table frame, shape (n, 2, 2), m; no step crosses an edge."""
    lengths_m = FOLD_LOOKS[fold.kind].dashes_m
    drawn = dashed(np.array(fold.start), np.array(fold.end), lengths_m).reshape(-1, 2)
    steps = placement.to_outer(drawn).reshape(-1, 2, 2)
    for side, corner in ((-1.0, top.low), (1.0, top.high)):
        for axis, place in enumerate(corner):
            for beyond in bent_at(_ABOVE_CLOTH_M) if np.isfinite(place) else ():
                steps = split_at(steps, axis, place + side * beyond)
    return steps


def _in_space(lines: Sequence[FloatArray], cloth: ClothSurface, top: TableTop) -> list[FloatArray]:
    """Return lines in steps, shapes (n, 2, 3), m, each step at the height of the highest cloth under it.

    Steps without cloth under them are left out.
    """
    steps = np.concatenate([_NOTHING[..., :2], *lines])
    owners = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
    asked = np.stack([steps[:, 0], steps.mean(axis=1), steps[:, 1]], axis=1)
    heights = Relief.of(cloth).heights_at(asked.reshape(-1, 2)).reshape(-1, 3)
    is_on_cloth = np.isfinite(heights[:, 1])
    steps, owners, gaps = steps[is_on_cloth], owners[is_on_cloth], heights[is_on_cloth].max(axis=1) + _ABOVE_CLOTH_M
    unrolled = np.concatenate([steps, np.zeros((len(steps), 2, 1))], axis=2)
    points = draped(top, unrolled, gaps[:, None])
    return [points[owners == number] for number in range(len(lines))]


def solid(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a plane line in steps, shape (n, 2, 2), short enough to follow the cloth up and down."""
    steps = max(1, int(np.ceil(np.hypot(*(end - start)) / _STEP_M)))
    points = start + (end - start) * np.linspace(0.0, 1.0, steps + 1)[:, None]
    return np.stack([points[:-1], points[1:]], axis=1)


def dashed(start: FloatArray, end: FloatArray, lengths_m: Sequence[float]) -> FloatArray:
    """Return a plane line in dashes, in the same short steps as `solid`, shape (n, 2, 2).

    Args:
        start: its start, shape (2,), m.
        end: its end.
        lengths_m: the lengths of dashes and gaps by turns, an even number; a line without any is solid.
    """
    if not lengths_m:
        return solid(start, end)
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length
    marks, at, pairs = [], 0.0, cycle(zip(lengths_m[::2], lengths_m[1::2], strict=True))
    while at < length:
        dash_m, gap_m = next(pairs)
        stop = min(length, at + dash_m)
        marks.append(solid(start + at * along, start + stop * along))
        at = stop + gap_m
    return np.concatenate(marks)


def split_at(segments: FloatArray, axis: int, place: float) -> FloatArray:
    """Return segments, shape (n, 2, 2), with those that cross a coordinate's value cut in two there."""
    from_m, to_m = segments[:, 0, axis], segments[:, 1, axis]
    is_crossing = (from_m - place) * (to_m - place) < 0.0
    crossing = segments[is_crossing]
    share = ((place - from_m[is_crossing]) / (to_m - from_m)[is_crossing])[:, None]
    middle = crossing[:, 0] + share * (crossing[:, 1] - crossing[:, 0])
    middle[:, axis] = place
    halves = (np.stack([crossing[:, 0], middle], axis=1), np.stack([middle, crossing[:, 1]], axis=1))
    return np.concatenate([segments[~is_crossing], *halves])
