"""Fit a stack that lies about where it ought to, with how its last fold and its creases lie (paper, section 8).

A robot that has just made a fold knows about where everything lies. So unknown are six numbers, none of them far from
what is expected: the placement, how far the last crease is beside its line and turned, and how far inside of their
lines all creases lie because cloth turns over in loops. Where the outline does not tell one of them, it stays as
expected, and the error says how far off that may be. Of cloth that was halved either half may stick out: of several
minima the mean is returned, each with its weight, and the error covers them.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import least_squares

from app.rehearsal.vision.fit_fold import FoldedOutline
from app.rehearsal.vision.fit_stack import thinned
from app.rehearsal.vision.outline_edges import CreaseEdges
from app.rehearsal.vision.seen_stack import SeenStack
from app.rehearsal.vision.stack_figure import Figure
from app.rehearsal.vision.stack_fit import Expected, StackFit
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import FloatArray, Pose2

_FOLDED = ((0.0, 0.006), (0.0, 0.01), (0.004, 0.003))
"""How far the last crease is beside its line (m) and turned (rad), and all creases inside of theirs (m): what is
expected, mean and standard deviation."""

_POINTS = 120
_SCALE_M = 0.005
_FIRST_SPREAD_M, _LEAST_SPREAD_M = 0.003, 0.0005
_STEPS = (5e-4, 2e-3)
_STARTS_M = (0.008, -0.008)

_CORRELATED_M = 0.2
"""Errors of an outline seen count as alike over that length (m): a shadow's edge, a wrinkle, a crooked crease.

Calibrated: with it two standard deviations cover 95 of 100 looks at rendered stacks (docs/vision.md); with .04 m, 68.
"""

_ALIKE = np.array([0.003, 0.003, 0.01, 0.002, 0.006, 0.004])
"""The largest distance between minima that count as one."""

_UNLIKELY = 60.0

_IMPOSSIBLE = 16.3
"""The squared distance from the expected placement, in standard deviations, that one in a thousand exceeds."""

_TURNED_M = 0.1
"""How far a crease that is turned is beside its line, for each radian (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class _Minimum:
    row: FloatArray
    cost: float
    covariance: FloatArray
    distances: FloatArray


@dataclass(frozen=True)
class Creased:
    """The least squares for one outline seen.

    Attributes:
        sequence: the garment's folds.
        folds: those done, in the order in which they were made.
        near: where the stack is expected.
        seen: points of its outline, table frame, shape (n, 2), m.
    """

    sequence: FoldSequence
    folds: tuple[int, ...]
    near: Expected
    seen: FloatArray

    @staticmethod
    def of(contour: FloatArray, sequence: FoldSequence, folds: tuple[int, ...], near: Expected) -> "Creased":
        """Return the problem for an outline seen, shape (n, 2), m; raises `ValueError` for points of no use."""
        return Creased(sequence, folds, near, thinned(contour, _POINTS))

    @cached_property
    def figure(self) -> Figure:
        """The outline as planned."""
        return Figure.of(self.sequence.cloth(self._done))

    @cached_property
    def folded(self) -> FoldedOutline | None:
        """The outline for any last crease; None of cloth that is spread out, or was turned over last."""
        if not self.folds or FOLD_KINDS[self.sequence.folds[self.folds[-1]].kind].is_whole:
            return None
        return FoldedOutline(self.sequence, self._done & ~(1 << self.folds[-1]), self.folds[-1])

    def fitted(self, whole: StackFit) -> SeenStack:
        """Return the fit, begun where the outline as planned fits, and where it does as well."""
        first = self._minimum(self._flat(whole.placement), _FIRST_SPREAD_M)
        spread_m = max(1.4826 * float(np.median(np.abs(first.distances))), _LEAST_SPREAD_M)
        found = [self._minimum(first.row, spread_m)]
        found += [self._minimum(self._flat(pose), spread_m) for pose in whole.others if self._is_likely(pose)]
        if self.folded is not None:
            found += [self._minimum(self._with_crease(first.row, offset_m), spread_m) for offset_m in _STARTS_M]
            best = min(found, key=lambda one: one.cost).row
            others = self.folded.on_other_sides(self.figure, best[:5])
            found += [self._minimum(np.array([*row, best[5]]), spread_m) for row in others]
        row, covariance = _mean(_distinct(found))
        return SeenStack(self.figure, self.folded, row, covariance)

    def fit_of(self, found: SeenStack) -> StackFit:
        """Return the placement by a fit, with an error that covers all placements that fit as well."""
        figure, inside_m = self._figure(found.row[3:5]), 0.0 if self.folded is None else self._inside(found.row)
        error_m = found.placement_error_m
        return figure.fit_of(found.row[:3], self.seen, [], is_ambiguous=False, error_m=error_m, inside_m=inside_m)

    def _flat(self, pose: Pose2) -> FloatArray:
        """Return the row of a stack that lies there, its crease as expected."""
        return np.array([*self.figure.fit_at(pose).row, *self._means[3:]])

    def _is_likely(self, pose: Pose2) -> bool:
        """Return whether a stack may lie there, from where it is expected."""
        beside = self.figure.fit_at(pose).row - self._means[:3]
        beside[2] = math.remainder(beside[2], math.tau)
        return float(((beside / self._sds[:3]) ** 2).sum()) < _IMPOSSIBLE

    def _figure(self, crease: FloatArray) -> Figure:
        if self.folded is None or not crease.any():
            return self.figure
        return self.figure.folded_to(self.folded.region(float(crease[0]), float(crease[1])))

    @property
    def _done(self) -> int:
        return sum(1 << fold for fold in self.folds)

    @cached_property
    def _creases(self) -> CreaseEdges:
        return CreaseEdges.of(self.sequence.cloth(self._done), self.sequence.garment.pattern)

    @cached_property
    def _means(self) -> FloatArray:
        return np.array([*self.figure.fit_at(self.near.placement).row, *(mean for mean, _ in self._of_folds)])

    @cached_property
    def _sds(self) -> FloatArray:
        place, angle = self.near.within_m, self.near.within_rad
        return np.array([place, place, angle, *(sd for _, sd in self._of_folds)])

    @property
    def _of_folds(self) -> tuple[tuple[float, float], ...]:
        return () if self.folded is None else _FOLDED

    def _with_crease(self, row: FloatArray, offset_m: float) -> FloatArray:
        return np.array([*row[:3], offset_m, 0.0, self._means[5]])

    def _residuals(self, row: FloatArray) -> FloatArray:
        """Return how far the points seen are outside the outline (m), shape (n,)."""
        distances, _ = self._figure(row[3:5]).residuals(row[:3], self.seen)
        return distances if self.folded is None else distances + self._inside(row)

    def _derivatives(self, row: FloatArray) -> FloatArray:
        """Return the derivatives of the residuals, shape (n, 3 or 6)."""
        distances, by_pose = self._figure(row[3:5]).residuals(row[:3], self.seen)
        if self.folded is None:
            return by_pose
        by_crease = [
            (self._figure(row[3:5] + step).residuals(row[:3], self.seen)[0] - distances) / step.sum()
            for step in np.diag(_STEPS)
        ]
        return np.column_stack([by_pose, *by_crease, self._at_creases(row)])

    def _inside(self, row: FloatArray) -> FloatArray:
        """Return how far inside of the outline each point seen should lie, shape (n,), m."""
        return float(row[5]) * self._at_creases(row)

    def _at_creases(self, row: FloatArray) -> FloatArray:
        """Return 1 for each point seen that is of a crease, 0 for the others, shape (n,)."""
        inner = self.figure.pose(row).to_inner(self.seen)
        distances, outwards = self._figure(row[3:5]).edges.distances(inner)
        slack_m = abs(float(row[3])) + abs(float(row[4])) * _TURNED_M
        return np.where(self._creases.are_creases(inner - distances[:, None] * outwards, slack_m), 1.0, 0.0)

    def _minimum(self, start: FloatArray, spread_m: float) -> _Minimum:
        """Return the minimum reached from a row, for a spread of the points seen (m)."""
        count = len(self.seen)
        independent = min(count, max(4.0, self.figure.edges.length / _CORRELATED_M))
        scale_m = spread_m * math.sqrt(count / independent)
        found = least_squares(
            lambda row: np.concatenate([self._residuals(row), scale_m * (row - self._means) / self._sds]),
            start,
            jac=lambda row: np.vstack([self._derivatives(row), scale_m * np.diag(1.0 / self._sds)]),
            loss=lambda squares: _loss(squares, count),
            f_scale=_SCALE_M,
            x_scale=self._sds,
            max_nfev=12,
        )
        distances, derivatives = self._residuals(found.x), self._derivatives(found.x)
        weights = 1.0 / (1.0 + (distances / _SCALE_M) ** 2)
        normal = (derivatives * weights[:, None]).T @ derivatives / scale_m**2 + np.diag(1.0 / self._sds**2)
        covariance = np.asarray(np.linalg.inv(normal), dtype=np.float64)
        return _Minimum(found.x, 2.0 * float(found.cost) / scale_m**2, covariance, distances)


def _loss(squares: FloatArray, count: int) -> FloatArray:
    """Return the loss and its derivatives, shape (3, n): Cauchy's of points seen, the square of what is expected."""
    seen = np.arange(len(squares)) < count
    share = 1.0 / (1.0 + squares)
    return np.stack(
        [np.where(seen, np.log1p(squares), squares), np.where(seen, share, 1.0), np.where(seen, -(share**2), 0.0)]
    )


def _distinct(found: list[_Minimum]) -> list[_Minimum]:
    kept: list[_Minimum] = []
    for one in sorted(found, key=lambda minimum: minimum.cost):
        alike = _ALIKE[: len(one.row)]
        if all((np.abs(one.row - other.row) > alike).any() for other in kept):
            kept.append(one)
    return kept


def _mean(found: list[_Minimum]) -> tuple[FloatArray, FloatArray]:
    """Return the mean over minima and its covariance, each minimum weighted by how likely what lies about it is."""
    weights = np.array(
        [
            math.exp(-0.5 * min(one.cost - found[0].cost, _UNLIKELY)) * math.sqrt(np.linalg.det(one.covariance))
            for one in found
        ]
    )
    weights /= weights.sum()
    rows = np.array([one.row for one in found])
    row = weights @ rows
    apart = rows - row
    inner = sum(weight * one.covariance for weight, one in zip(weights, found, strict=True))
    return row, np.asarray(inner + (weights[:, None] * apart).T @ apart)
