"""A stack's outline as a figure that is moved and turned until it lies on the points seen."""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from app.rehearsal.vision.outline_edges import OutlineEdges
from app.rehearsal.vision.stack_fit import TOO_UNCERTAIN, StackFit
from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.message import Message

ON_OUTLINE_M = 0.01
"""A point nearer to the outline than that lies on it (m)."""

POINTS = 240
"""Points of the outline used; more change the fit by less than .1 mm."""

ANGLES = 24
"""Angles from which the fit is begun."""

_COARSE_POINTS, _COARSE_M, _FINE_M = 80, 0.03, 0.005
_FITTED_COARSELY, _FITTED_FINELY = 24, 6
_SLID_M = (-0.06, -0.03, 0.03, 0.06)
_TURNED_RAD = (0.0, -0.15, 0.15)
_CAPPED_M, _FAR_M = 0.03, 0.1

LEAST_SHARE = 0.6
"""With fewer of the points on the outline, or less of the outline seen, the placement counts as unknown."""

_WORST_RESIDUAL_M = 0.008
_WORST_ERROR_M = 0.02

_CORRELATED_M = 0.04
"""Errors of an outline seen are alike over that length: a wrinkle, a shadow's edge (m)."""

_LEAST_ERROR_M = 0.002
"""The systematic error that no fit shows: the camera's own, or an outline that is wider or narrower all round (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class Fitted:
    """A placement reached by the least squares.

    Attributes:
        row: x and y of the figure's middle (m) and its yaw (rad), table frame.
        misfit_m: the mean distance between the points seen and the outline, both ways, each at most 3 cm (m).
    """

    row: FloatArray
    misfit_m: float


@dataclass(frozen=True, slots=True, eq=False)
class Figure:
    """A stack's outline about its middle, so that turning and moving it do not depend on each other.

    Attributes:
        middle: the middle of the outline, garment frame, shape (2,), m.
        edges: its edges.
        spaced: points evenly along it, shape (POINTS, 2), m.
        corners: the corners of its convex hull, shape (k, 2), m.
        area: the area that it encloses (m^2).
    """

    middle: FloatArray
    edges: OutlineEdges
    spaced: FloatArray
    corners: FloatArray
    area: float

    @staticmethod
    def of(stack: ClothState) -> "Figure":
        """Return a stack's figure."""
        return Figure.about(stack.silhouette)

    @staticmethod
    def about(outline: Region) -> "Figure":
        """Return the figure of an outline."""
        edges = OutlineEdges.of(outline)
        spaced = edges.spaced(POINTS)
        return Figure(spaced.mean(axis=0), edges, spaced, outline.hull, outline.area)

    def folded_to(self, outline: Region) -> "Figure":
        """Return the figure about the same middle, and with the same corners, that has another outline."""
        edges = OutlineEdges.of(outline)
        return replace(self, edges=edges, spaced=edges.spaced(POINTS), area=outline.area)

    def pose(self, row: FloatArray) -> Pose2:
        """Return the placement of the garment frame."""
        turned = Pose2(0.0, 0.0, float(row[2]))
        x, y = row[:2] - turned.to_outer(self.middle)
        return Pose2(float(x), float(y), float(row[2]))

    def fit_at(self, pose: Pose2) -> Fitted:
        """Return a placement that is given, as one fitted."""
        return Fitted(np.array([*pose.to_outer(self.middle), pose.yaw_rad]), math.inf)

    def apart(self, one: Fitted, other: Fitted) -> float:
        """Return how far two placements carry a corner of the figure apart, at most (m)."""
        a, b = self.pose(one.row).to_outer(self.corners), self.pose(other.row).to_outer(self.corners)
        return float(np.hypot(*(a - b).T).max())

    def residuals(self, row: FloatArray, seen: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far the points seen are outside the outline (m), shape (n,), and the derivatives, shape (n, 3)."""
        pose = self.pose(row)
        inner = pose.to_inner(seen)
        distances, outwards = self.edges.distances(inner)
        turned = Pose2(0.0, 0.0, pose.yaw_rad).to_outer(outwards)
        a, b = (inner - self.middle).T
        by_yaw = outwards[:, 0] * b - outwards[:, 1] * a
        return distances, np.column_stack([-turned, by_yaw])

    def fitted(
        self, row: FloatArray, seen: FloatArray, scale_m: float, steps: int, loss: str = "soft_l1"
    ) -> FloatArray:
        """Return the row that the least squares reach from another."""
        found = least_squares(
            lambda at: self.residuals(at, seen)[0],
            row,
            jac=lambda at: self.residuals(at, seen)[1],
            loss=loss,
            f_scale=scale_m,
            x_scale=(1.0, 1.0, 2.0),
            max_nfev=steps,
        )
        return np.asarray(found.x)

    def misfit(self, row: FloatArray, seen: FloatArray, most_m: float = _CAPPED_M) -> float:
        """Return `Fitted.misfit_m` of a row, each distance at most `most_m`."""
        there = np.abs(self.residuals(row, seen)[0])
        back = gaps(self.pose(row).to_outer(self.spaced), seen)
        return float((np.minimum(there, most_m).mean() + np.minimum(back, most_m).mean()) / 2.0)

    def candidates(self, seen: FloatArray, near: Pose2 | None) -> list[Fitted]:
        """Return the placements that the fit ends at from all round, the best first."""
        coarse = seen[:: max(1, len(seen) // _COARSE_POINTS)]
        starts = [row for k in range(ANGLES) for row in self._starts(math.tau * k / ANGLES, coarse)]
        starts.sort(key=lambda row: self.misfit(row, coarse, _FAR_M))
        given = [] if near is None else [self.fit_at(near).row]
        rough = [self.fitted(row, coarse, _COARSE_M, 12) for row in (*given, *starts[:_FITTED_COARSELY])]
        ranked = self._distinct([Fitted(row, self.misfit(row, coarse)) for row in rough])[:_FITTED_FINELY]
        fine = self.finely([one.row for one in ranked], seen)
        return self._distinct([*fine, *self.finely(self._slid(fine[0].row), seen)])

    def near_by(self, seen: FloatArray, near: Pose2) -> list[Fitted]:
        """Return the placements that the fit ends at from one that is nearly right, the best first."""
        coarse = seen[:: max(1, len(seen) // _COARSE_POINTS)]
        start = self.fit_at(near).row
        turns = [start + turn * np.array([0.0, 0.0, 1.0]) for turn in _TURNED_RAD]
        rough = [self.fitted(row, coarse, _COARSE_M, 12) for row in turns]
        best = min(rough, key=lambda row: self.misfit(row, coarse))
        return self.finely([*rough, *self._slid(best)], seen)

    def finely(self, rows: list[FloatArray], seen: FloatArray) -> list[Fitted]:
        """Return the placements that the fine fit ends at, the best first."""
        fine = [self.fitted(row, seen, _FINE_M, 30, "cauchy") for row in rows]
        return self._distinct([Fitted(row, self.misfit(row, seen)) for row in fine])

    def _slid(self, row: FloatArray) -> list[FloatArray]:
        """Return a placement slid along the longer side: the few points of a narrow end hardly pull."""
        own = self.spaced - self.middle
        along = np.linalg.eigh(own.T @ own)[1][:, -1]
        x, y = Pose2(0.0, 0.0, float(row[2])).to_outer(along)
        return [row + by_m * np.array([x, y, 0.0]) for by_m in _SLID_M]

    def _starts(self, yaw_rad: float, seen: FloatArray) -> list[FloatArray]:
        """Return placements with one yaw: with the middles upon each other, or an end, where an arm hides the other."""
        turned = Pose2(0.0, 0.0, yaw_rad)
        inner, own = turned.to_inner(seen), self.spaced - self.middle
        low, high = inner.min(axis=0) - own.min(axis=0), inner.max(axis=0) - own.max(axis=0)
        longer = int(np.ptp(own, axis=0).argmax())
        middle = (low + high) / 2.0
        ends = [np.where(np.arange(2) == longer, end, middle) for end in (low, high)]
        return [np.array([*turned.to_outer(place), yaw_rad]) for place in (middle, *ends, inner.mean(axis=0))]

    def _distinct(self, found: list[Fitted]) -> list[Fitted]:
        """Return placements without those nearly equal to a better one, the best first."""
        kept: list[Fitted] = []
        for one in sorted(found, key=lambda fitted: fitted.misfit_m):
            if all(self.apart(one, other) > ON_OUTLINE_M for other in kept):
                kept.append(one)
        return kept

    def chosen(self, candidates: list[Fitted], seen: FloatArray, near: Pose2 | None) -> StackFit:
        """Return the best of some placements; of several that fit as well, the one nearest to `near`."""
        best = candidates[0]
        alike = [best, *(one for one in candidates[1:] if fits_as_well(one.misfit_m, best.misfit_m))]
        is_ambiguous = len(alike) > 1
        if near is not None and is_ambiguous:
            start = self.fit_at(near)
            alike.sort(key=lambda one: self.apart(one, start))
            is_ambiguous = self.apart(alike[0], start) > 0.5 * self.apart(alike[1], start)
        return self.fit_of(alike[0].row, seen, [self.pose(one.row) for one in alike[1:]], is_ambiguous=is_ambiguous)

    def fit_of(
        self,
        row: FloatArray,
        seen: FloatArray,
        others: list[Pose2],
        *,
        is_ambiguous: bool,
        error_m: float | None = None,
        inside_m: FloatArray | float = 0.0,
    ) -> StackFit:
        """Return a placement with its error, or why it is not known.

        Args:
            row: the placement.
            seen: the points seen, table frame, shape (n, 2), m.
            others: placements that fit as well.
            is_ambiguous: whether one of these may be the right one.
            error_m: how far off the corners may be (m); None for what the outline alone tells.
            inside_m: how far inside of the outline each point seen is expected, shape (n,), m.
        """
        outside, derivatives = self.residuals(row, seen)
        distances, pose = outside + inside_m, self.pose(row)
        if error_m is None:
            error_m = self._corner_error(covariance_of(distances, derivatives, self.edges.length), pose)
        residual_m = float(np.median(np.abs(distances)))
        on = float((np.abs(distances) <= ON_OUTLINE_M).mean())
        is_seen = float((gaps(pose.to_outer(self.spaced), seen) <= ON_OUTLINE_M + self._spacing(seen)).mean())
        unknown = why_unknown(error_m, residual_m, on, is_seen, len(others), is_ambiguous=is_ambiguous)
        return StackFit(
            pose, error_m, residual_m, on, is_seen, self._overlap(distances, inside_m), tuple(others), unknown
        )

    def _overlap(self, distances: FloatArray, inside_m: FloatArray | float) -> float:
        """Return `StackFit.overlap` of points that are so far outside of where they are expected, shape (n,), m.

        Each stands for as long a piece of the outline as the others, and for a strip as wide as it is off. That is just
        so where they are off by little; of cloth that sticks out it is more than its area, and of a corner that is
        missing .7 of it at least, since its hypotenuse is near to both legs.
        """
        expected = self.area - self.edges.length * float(np.mean(inside_m))
        beyond, missing = (self.edges.length * float(np.maximum(side, 0.0).mean()) for side in (distances, -distances))
        return max(0.0, expected - missing) / (expected + beyond)

    def _spacing(self, seen: FloatArray) -> float:
        return self.edges.length / len(seen) / 2.0

    def _corner_error(self, covariance: FloatArray, pose: Pose2) -> float:
        """Return twice the standard deviation of the least certain corner, in its least certain direction (m)."""
        arms = Pose2(0.0, 0.0, pose.yaw_rad).to_outer(self.corners - self.middle)
        worst = 0.0
        for x, y in arms:
            by_row = np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])
            worst = max(worst, float(np.linalg.eigvalsh(by_row @ covariance @ by_row.T)[-1]))
        return math.hypot(2.0 * math.sqrt(worst), _LEAST_ERROR_M)


def covariance_of(distances: FloatArray, derivatives: FloatArray, length_m: float) -> FloatArray:
    """Return the covariance of fitted parameters, from the spread of the residuals.

    Points beside each other err alike, so as many count as there are stretches of `_CORRELATED_M` on the outline; the
    weight of each falls with its residual as it does in the fit.
    """
    spread_m = max(1.4826 * float(np.median(np.abs(distances))), 5e-4)
    weights = 1.0 / (1.0 + (distances / _FINE_M) ** 2)
    normal = (derivatives * weights[:, None]).T @ derivatives
    independent = min(len(distances), max(4.0, length_m / _CORRELATED_M))
    damped = normal + 1e-9 * len(distances) * np.eye(len(normal))
    return np.asarray(np.linalg.inv(damped) * spread_m**2 * len(distances) / independent)


def why_unknown(
    error_m: float, residual_m: float, on: float, is_seen: float, others: int, *, is_ambiguous: bool
) -> Message | None:
    """Return why a placement is not known; None where it is."""
    if on < LEAST_SHARE or residual_m > _WORST_RESIDUAL_M:
        text = f"what was seen does not fit: {on:.0%} of it lies on the outline, half of it within {residual_m:.4f} m"
        return Message("seen_does_not_fit", text, {"share": on, "residual_m": residual_m})
    if is_seen < LEAST_SHARE:
        text = f"too little was seen: {is_seen:.0%} of the outline"
        return Message("too_little_seen", text, {"share": is_seen})
    if is_ambiguous:
        text = f"{others + 1} placements fit equally well"
        return Message("looks_alike", text, {"placements": others + 1})
    if error_m > _WORST_ERROR_M:
        text = f"the corners may be {error_m:.3f} m off"
        return Message(TOO_UNCERTAIN, text, {"error_m": error_m})
    return None


def gaps(points: FloatArray, others: FloatArray) -> FloatArray:
    """Return how far each of some points, shape (n, 2), is from the nearest of others, shape (m, 2), m."""
    return np.asarray(np.sqrt(((points[:, None] - others) ** 2).sum(axis=2).min(axis=1)))


def fits_as_well(misfit_m: float, least_m: float) -> bool:
    """Return whether a misfit is too near to the least one (m) to tell which of the two fits better."""
    return misfit_m <= 1.25 * least_m + 0.0005
