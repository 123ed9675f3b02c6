"""Look for a known stack in the picture of a camera whose pose is known (paper, section 8).

A robot knows more than a picture shows: where the table is, where its own arms hide it, and about where the stack
lies. What is off the table or behind an arm is left out, and what is well away from where the stack ought to be shows
the table's colours. Points of the outline at the table's edge and beside an arm are not of the stack's outline.
"""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import cv2
import numpy as np

from app.rehearsal.camera.camera import Camera
from app.rehearsal.vision.edge_heights import EdgeHeights
from app.rehearsal.vision.fit_creased import Creased
from app.rehearsal.vision.fit_stack import fit_near
from app.rehearsal.vision.on_table import why_in_doubt
from app.rehearsal.vision.picture import Image
from app.rehearsal.vision.seen_stack import SeenStack
from app.rehearsal.vision.segment import Mask, segment
from app.rehearsal.vision.stack_fit import TOO_UNCERTAIN, Expected, StackFit, unknown_json
from app.rehearsal.vision.vision_errors import NothingToldError
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table
from planner.message import Message

_AWAY_M = 0.1
"""The distance from the expected place of the stack beyond which the picture shows the table (m)."""

_LEAST_TABLE = 0.03
"""The least share of the picture known to be table; with less, the picture's border counts as table."""

_BESIDE_ARM_PX, _BESIDE_TABLE_PX = 5, 3
"""The distances from an arm, and from the table's edge, within which outline points are left out (pixels)."""

_LEAST_POINTS = 40


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """The result of a look at a stack.

    Attributes:
        fit: where it lies; None where nothing was found that could be it.
        contour: the points of its outline seen, shape (n, 2), pixels.
        fitted: the fitted outline, shape (m, 2), pixels; empty without a fit.
        unknown: why it is not known where it lies; None where it is.
        expected: the outline where it ought to lie, shape (k, 2), pixels.
        stack: where its points lie, those of its last fold too; None without a fit, or where no picture was looked at.
    """

    fit: StackFit | None
    contour: FloatArray
    fitted: FloatArray
    unknown: Message | None
    expected: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    stack: SeenStack | None = None

    @property
    def is_estimate(self) -> bool:
        """Whether the fit is the best guess: of one that is only uncertain, what was expected is a part."""
        return self.fit is not None and (self.unknown is None or self.unknown.code == TOO_UNCERTAIN)

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON, outlines to a tenth of a pixel."""
        return {
            "fit": None if self.fit is None else self.fit.to_dict(),
            "fitted_px": np.round(self.fitted, 1).tolist(),
            "expected_px": np.round(self.expected, 1).tolist(),
            **unknown_json(self.unknown),
            "crease": None if self.stack is None else self.stack.to_dict(),
        }


@dataclass(frozen=True, slots=True, eq=False)
class Looker:
    """Looks for stacks on a table with a camera.

    Attributes:
        camera: the camera, as it is believed to be.
        table: the table.
        hidden: which pixels show the robot, shape of the picture.
    """

    camera: Camera
    table: Table
    hidden: BoolArray

    def look(
        self, image: Image, sequence: FoldSequence, folds: tuple[int, ...], ought: Pose2, near: Expected | None = None
    ) -> Sight:
        """Return where a stack lies.

        Args:
            image: blue, green, red.
            sequence: the garment's folds.
            folds: those done, in the order in which they were made.
            ought: where the stack ought to lie.
            near: where it is expected, if more is known than that it should be about there.
        """
        near = near or Expected(ought)
        stack = sequence.cloth(sum(1 << fold for fold in folds))
        heights = EdgeHeights.of(stack, sequence.garment)
        height_m = heights.middle_m
        rings = [self._pixels(ought.to_outer(ring), height_m) for ring in stack.silhouette.rings]
        expected = max(rings, key=len)
        off_table = ~self._painted([self._pixels(np.array(self.table.corners), 0.0)])
        away = off_table | self.hidden
        reach = math.ceil(_AWAY_M * self.camera.focal_px / self.camera.position[2])
        disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
        near_by = cv2.dilate(self._painted(rings).astype(np.uint8), disc) > 0
        part = _round(near_by, reach)
        table = (~near_by & ~away)[part]
        try:
            seen = segment(image[part], away[part], table if table.mean() > _LEAST_TABLE else None, is_known=True)
        except NothingToldError as error:
            return _blind(error.says, expected)
        contour = seen.contour + np.array([part[1].start, part[0].start])
        is_beside = self._is_beside(contour, self.hidden, _BESIDE_ARM_PX)
        contour = contour[~(is_beside | self._is_beside(contour, off_table, _BESIDE_TABLE_PX))]
        if len(contour) < _LEAST_POINTS:
            return _blind(Message("outline_hidden", "almost all of the outline is hidden"), expected)
        whole = fit_near(self.camera.on_plane(contour, height_m), stack, near.placement)
        on_table = heights.seen_at(self.camera, contour, whole.placement)
        creased = Creased.of(on_table, sequence, folds, near)
        found = replace(creased.fitted(whole), outline=on_table)
        fit = creased.fit_of(found)
        doubt = why_in_doubt(replace(seen, at_border=0.0), None)
        fitted = [self._pixels(fit.placement.to_outer(ring), height_m) for ring in stack.silhouette.rings]
        return Sight(fit, contour, max(fitted, key=len), fit.unknown or doubt, expected=expected, stack=found)

    def _pixels(self, points: FloatArray, height_m: float) -> FloatArray:
        return self.camera.pixels(np.column_stack([points, np.full(len(points), height_m)]))

    def _painted(self, rings: list[FloatArray]) -> BoolArray:
        width, height = self.camera.size_px
        mask: Mask = np.zeros((height, width), np.uint8)
        cv2.fillPoly(mask, [np.round(ring).astype(np.int32) for ring in rings], 1)
        return mask > 0

    def _is_beside(self, pixels: FloatArray, away: BoolArray, most_px: int) -> BoolArray:
        """Return which pixels are that near to what is not looked at, shape (n,)."""
        size = 2 * most_px + 1
        wide = cv2.dilate(away.astype(np.uint8), np.ones((size, size), np.uint8)) > 0
        width, height = self.camera.size_px
        columns, rows = np.clip(np.round(pixels).astype(np.int64), 0, [width - 1, height - 1]).T
        return np.asarray(wide[rows, columns])


def _round(mask: BoolArray, margin: int) -> tuple[slice, slice]:
    """Return the rows and columns of a mask's box, wider all round by a margin (pixels)."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    spans = [
        slice(max(0, int(one[0]) - margin), min(size, int(one[-1]) + 1 + margin)) if len(one) else slice(0, size)
        for one, size in zip((rows, columns), mask.shape, strict=True)
    ]
    return spans[0], spans[1]


def _blind(why: Message, expected: FloatArray) -> Sight:
    return Sight(None, np.empty((0, 2)), np.empty((0, 2)), why, expected=expected)
