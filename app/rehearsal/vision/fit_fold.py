"""Fit a stack after its last fold, with that fold's crease as a further unknown (paper, section 8).

A fold that went wrong leaves another polygon: the crease lies beside its line, or turned. So placement and crease are
fitted together, five numbers, the outline folded anew for each crease tried. Nothing is cut or torn there: what is
beyond the ends of the line stays as it is. Of two creases that fit equally well the one nearer to where the stack
ought to lie is taken, and the errors cover the other.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import least_squares

from app.rehearsal.vision.fit_stack import fit_stack, thinned
from app.rehearsal.vision.stack_figure import POINTS, Figure, Fitted, covariance_of
from app.rehearsal.vision.stack_fit import FoldFit
from planner.cloth.fold_kinds import FOLD_KINDS, FoldKind
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.message import Message

CREASE_OFF_M = 0.08
"""A crease is looked for so far from its line (m)."""

CREASE_TURN_RAD = 0.35
"""A crease is looked for so far turned against its line (rad)."""

_STARTS_M = (0.0, 0.025, -0.025)
"""Offsets of the crease from which the fit is begun (m)."""

_ALIKE_M = 1e-4
_STEP = (5e-4, 2e-3)
_FINE_M = 0.005
_WORST_CREASE_ERROR_M = 0.02


@dataclass(frozen=True)
class FoldedOutline:
    """The outline that one more fold leaves, as its crease moves.

    Attributes:
        sequence: the garment's folds.
        done: the folds done before, as a bit mask.
        index: the fold.
    """

    sequence: FoldSequence
    done: int
    index: int

    def region(self, offset_m: float, turn_rad: float) -> Region:
        """Return the silhouette with the crease moved to its left and turned counter-clockwise about its middle."""
        line = self.crease(offset_m, turn_rad)
        left, _ = self._movable.parted_by(line)
        stays = self._active.difference(left)
        return Region.union([self._below, stays, left.moved(Isometry.reflection(line))])

    def crease(self, offset_m: float, turn_rad: float) -> Segment:
        """Return the crease's line, moved and turned."""
        line = self.line
        middle = np.array(line.at(line.length / 2.0)) + offset_m * np.array(line.left)
        heading = math.atan2(line.direction[1], line.direction[0]) + turn_rad
        half = line.length / 2.0 * np.array([math.cos(heading), math.sin(heading)])
        (ax, ay), (bx, by) = middle - half, middle + half
        return Segment((float(ax), float(ay)), (float(bx), float(by)))

    def off(self, offset_m: float, turn_rad: float) -> float:
        """Return how far the corners of the part that moved are from where they should be, at most (m)."""
        planned = Isometry.reflection(self.line).apply(self._moving.hull)
        return float(np.hypot(*(self.astray(offset_m, turn_rad).apply(planned) - planned).T).max())

    def astray(self, offset_m: float, turn_rad: float) -> Isometry:
        """Return the isometry from where the part that moved should lie to where it lies, garment frame."""
        return Isometry.reflection(self.crease(offset_m, turn_rad)).after(Isometry.reflection(self.line))

    def on_other_sides(self, figure: Figure, row: FloatArray) -> list[FloatArray]:
        """Return placements and creases that may fit as well: of halved cloth either half may be the one that moved.

        Args:
            figure: the outline as planned.
            row: x, y, yaw, the crease's offset and its turn.
        """
        x, y, yaw_rad, offset_m, turn_rad = row.tolist()
        astray = self.astray(offset_m, turn_rad)
        middle = figure.pose(row).to_outer(astray.apply(figure.middle))
        return [
            np.array([*middle, yaw_rad + 2.0 * turn_rad, -offset_m, -turn_rad]),
            np.array([x, y, yaw_rad, offset_m, -turn_rad]),
            np.array([x, y, yaw_rad, -offset_m, turn_rad]),
        ]

    @cached_property
    def landed(self) -> Region:
        """The region that the part moved by the last fold covers where it should lie."""
        return self._moving.moved(Isometry.reflection(self.line))

    @property
    def line(self) -> Segment:
        """The fold's line, garment frame, the part that moved to its left."""
        return self.sequence.folds[self.index].line

    @property
    def _kind(self) -> FoldKind:
        return FOLD_KINDS[self.sequence.folds[self.index].kind]

    @cached_property
    def _moving(self) -> Region:
        return self.sequence.folded(self.done, self.index).moving

    @cached_property
    def _active(self) -> Region:
        return self._kind.silhouette(self.sequence.cloth(self.done))

    @cached_property
    def _below(self) -> Region:
        cloth = self.sequence.cloth(self.done)
        staying = cloth.layers[: len(cloth.layers) - len(self._kind.layers(cloth))]
        return Region.union(layer.region for layer in staying) if staying else Region.empty()

    @cached_property
    def _movable(self) -> Region:
        """The part that moves, and a strip beyond the line, in which the crease may lie."""
        line = self.line
        (ax, ay), (bx, by) = line.start, line.end
        nx, ny = np.array(line.left) * CREASE_OFF_M
        strip = Region.polygon([(ax + nx, ay + ny), (ax - nx, ay - ny), (bx - nx, by - ny), (bx + nx, by + ny)])
        return Region.union([self._moving, self._active.intersection(strip)])


def fit_fold(contour: FloatArray, sequence: FoldSequence, done: int, index: int, near: Pose2 | None = None) -> FoldFit:
    """Return where a stack lies after a fold, and how far its crease is from its line.

    Args:
        contour: points of the visible outline in the table frame, as for `fit_stack`.
        sequence: the garment's folds.
        done: the folds done before, as a bit mask.
        index: the fold done last.
        near: where the stack ought to lie.

    Raises:
        ValueError: there are fewer than 8 points, or one is not finite.
    """
    planned = sequence.folded(done, index).cloth
    whole = fit_stack(contour, planned, near)
    seen = thinned(contour, POINTS)
    fit = _CreaseFit(Figure.of(planned), FoldedOutline(sequence, done, index), seen)
    middle = fit.figure.fit_at(whole.placement).row
    found = [fit.fitted(np.array([*middle, offset_m, 0.0])) for offset_m in _STARTS_M]
    best = min(found, key=lambda one: one.misfit_m)
    found += [fit.fitted(row) for row in fit.folded.on_other_sides(fit.figure, best.row)]
    best = min(found, key=lambda one: one.misfit_m)
    alike = [one for one in found if one.misfit_m <= 1.1 * best.misfit_m + _ALIKE_M]
    kept = fit.figure.fit_at(whole.placement if near is None else near)
    alike.sort(key=lambda one: fit.figure.apart(one, kept))
    spread = np.abs([one.row - alike[0].row for one in alike]).max(axis=0)
    return fit.fit_of(alike[0].row, spread[3:], whole.others, near)


@dataclass(frozen=True, slots=True, eq=False)
class _CreaseFit:
    """The least squares over placement and crease: x, y, yaw, the crease's offset and its turn.

    Attributes:
        figure: the outline as planned.
        folded: the outline for any crease.
        seen: the points seen, table frame, shape (n, 2), m.
    """

    figure: Figure
    folded: FoldedOutline
    seen: FloatArray

    def with_crease(self, crease: FloatArray) -> Figure:
        """Return the figure about the middle of the planned one that the fold leaves with another crease."""
        return self.figure.folded_to(self.folded.region(float(crease[0]), float(crease[1])))

    def residuals(self, row: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far the points seen are outside the folded outline (m), and the derivatives, shape (n, 5)."""
        distances, by_pose = self.with_crease(row[3:]).residuals(row[:3], self.seen)
        by_crease = [
            (self.with_crease(row[3:] + step).residuals(row[:3], self.seen)[0] - distances) / step.sum()
            for step in np.diag(_STEP)
        ]
        return distances, np.column_stack([by_pose, *by_crease])

    def fitted(self, start: FloatArray) -> Fitted:
        """Return what the least squares reach from a start, shape (5,)."""
        most = np.array([np.inf, np.inf, np.inf, CREASE_OFF_M, CREASE_TURN_RAD])
        found = least_squares(
            lambda row: self.residuals(row)[0],
            start,
            jac=lambda row: self.residuals(row)[1],
            bounds=(-most, most),
            loss="cauchy",
            f_scale=_FINE_M,
            x_scale=(1.0, 1.0, 2.0, 1.0, 4.0),
            max_nfev=20,
        )
        row = np.asarray(found.x)
        return Fitted(row, self.with_crease(row[3:]).misfit(row[:3], self.seen))

    def fit_of(self, row: FloatArray, spread: FloatArray, others: tuple[Pose2, ...], near: Pose2 | None) -> FoldFit:
        """Return the placement and the crease of a fit, with their errors.

        Args:
            row: placement and crease.
            spread: how far other creases that fit as well are from this one.
            others: other placements that fit the planned outline.
            near: where the stack ought to lie.
        """
        offset_m, turn_rad = row[3:].tolist()
        there = self.with_crease(row[3:])
        candidates = there.finely([row[:3], *(there.fit_at(other).row for other in others)], self.seen)
        seen_so = there.chosen(candidates, self.seen, near)
        distances, derivatives = self.residuals(row)
        errors = (
            2.0 * np.sqrt(np.diagonal(covariance_of(distances, derivatives, self.figure.edges.length))[3:]) + spread
        )
        if seen_so.unknown is None and errors[0] > _WORST_CREASE_ERROR_M:
            text = f"the crease may be {errors[0]:.3f} m off"
            seen_so = replace(seen_so, unknown=Message("too_uncertain", text, {"error_m": float(errors[0])}))
        return FoldFit(
            seen_so, offset_m, turn_rad, self.folded.off(offset_m, turn_rad), float(errors[0]), float(errors[1])
        )
