"""A stack as it was seen: where its points lie, those of its last fold too, and how far off they may be."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from app.rehearsal.vision.fit_fold import FoldedOutline
from app.rehearsal.vision.outline_edges import OutlineEdges
from app.rehearsal.vision.stack_figure import Figure
from app.rehearsal.vision.stack_fit import Expected
from planner.geometry.pose import FloatArray, Pose2

_MOVED_M = 1e-4
"""The largest distance from the part that moved to a point of it (m)."""

_NUDGES = np.array([1e-4, 1e-4, 1e-3, 1e-4, 1e-3, 1e-4])

_AT_EDGE_M = 0.005
"""The largest distance from the outline to a point of the edge (m)."""

_ROUND_EDGE_M = 0.03
"""The distance from a point of the edge within which the outline seen tells where the edge lies (m)."""

_EDGE_M, _CONTOUR_M = 0.008, 0.002
"""Standard deviations of an edge from the fitted outline, and of the outline seen from the edge (m)."""

_LEAST_ERROR_M = 0.002
"""The systematic error that no fit shows (m): the camera's own, or an outline wider or narrower all round."""


@dataclass(frozen=True, slots=True, eq=False)
class SeenStack:
    """The placement of a stack and of its last fold.

    Attributes:
        figure: the outline as planned.
        folded: its last fold; None of spread-out cloth.
        row: x and y of the figure's middle (m), its yaw (rad), how far the last crease is to the left of its line (m)
            and turned (rad), and how far inside of their lines creases lie (m); of spread-out cloth the first three.
        covariance: of these numbers.
        outline: the points seen of its outline, table frame, shape (n, 2), m.
    """

    figure: Figure
    folded: FoldedOutline | None
    row: FloatArray
    covariance: FloatArray
    outline: FloatArray = field(default_factory=lambda: np.empty((0, 2)))

    @property
    def placement(self) -> Pose2:
        """The garment frame in the table frame."""
        return self.figure.pose(self.row)

    def beside(self, points: FloatArray) -> FloatArray:
        """Return the offsets of points of the part that moved last from where they should lie, shape (n, 2), m.

        Points and offsets are in the garment frame; other points have no offset. Points of the fold's line count as on
        the crease, because that is the edge that hands take.
        """
        return self._beside(self.row, points)

    def edge_beside(self, points: FloatArray) -> FloatArray:
        """Return the offsets of the edge as seen from the fitted outline, at points of the stack, shape (n, 2), m.

        Cloth turns over in loops, so an edge that is a crease lies inside of its line, further in one place than in
        another; at a corner both edges tell. Of points that are not of the fitted outline, or where little of it was
        seen, it is 0. Points and vectors are of the garment frame.
        """
        found = np.zeros_like(points)
        for number, normals, away in self._seen_round(points):
            shrunk = (_CONTOUR_M / _EDGE_M) ** 2 * max(1, len(away)) * np.eye(2)
            found[number] = np.linalg.solve(normals.T @ normals + shrunk, normals.T @ away)
        return found

    def is_edge_hidden(self, points: FloatArray) -> bool:
        """Return whether nothing was seen of the edge at one of some points of it, garment frame."""
        return any(not len(away) for _, _, away in self._seen_round(points))

    def places(self, points: FloatArray) -> FloatArray:
        """Return where points of the stack, garment frame, lie, shape (n, 2), table frame, m."""
        return self._places(self.row, points)

    def errors(self, points: FloatArray) -> FloatArray:
        """Return how far off each of these places may be, at 95 of 100, shape (n,), m."""
        return self._errors(points, len(self.row))

    @property
    def expected(self) -> Expected:
        """Where the stack is expected in the next look, if nothing moves it."""
        within_m = math.sqrt(np.linalg.eigvalsh(self.covariance[:2, :2])[-1])
        return Expected(self.placement, within_m, math.sqrt(self.covariance[2, 2]))

    @property
    def placement_error_m(self) -> float:
        """How far off the corners may be, at 95 of 100, with the last fold just where it was seen (m)."""
        return float(self._errors(self.figure.corners, 3).max())

    def to_dict(self) -> dict[str, Any] | None:
        """Return how the last fold lies as JSON; None of spread-out cloth."""
        names = ("offset_m", "turn_rad", "inset_m")
        return None if self.folded is None else dict(zip(names, self.row[3:].tolist(), strict=True))

    def _errors(self, points: FloatArray, count: int) -> FloatArray:
        """Return the errors of points for those of the first numbers of the row alone."""
        there = self.places(points)
        steps = np.diag(_NUDGES[: len(self.row)])[:count]
        by_row = np.array([(self._places(self.row + step, points) - there) / step.sum() for step in steps])
        derivatives = by_row.transpose(1, 2, 0)
        squares = np.linalg.eigvalsh(derivatives @ self.covariance[:count, :count] @ derivatives.transpose(0, 2, 1))
        return np.asarray(np.hypot(2.0 * np.sqrt(squares[:, -1]), _LEAST_ERROR_M))

    def _places(self, row: FloatArray, points: FloatArray) -> FloatArray:
        return self.figure.pose(row).to_outer(points + self._beside(row, points))

    def _seen_round(self, points: FloatArray) -> Iterator[tuple[int, FloatArray, FloatArray]]:
        """Yield what was seen round each point that is of the edge: its number, normals, distances (m)."""
        edges, there = self._edges, points + self.beside(points)
        inner = self.placement.to_inner(self.outline)
        distances, outwards = edges.distances(inner)
        feet = inner - distances[:, None] * outwards
        for number in np.flatnonzero(edges.gaps(there) <= _AT_EDGE_M).tolist():
            apart = np.hypot(*(feet - there[number]).T)
            near = (apart <= _ROUND_EDGE_M) & (np.abs(distances) <= _ROUND_EDGE_M)
            yield number, outwards[near], distances[near]

    @property
    def _edges(self) -> OutlineEdges:
        """The fitted outline, garment frame."""
        if self.folded is None:
            return self.figure.edges
        return OutlineEdges.of(self.folded.region(float(self.row[3]), float(self.row[4])))

    def _beside(self, row: FloatArray, points: FloatArray) -> FloatArray:
        if self.folded is None:
            return np.zeros_like(points)
        is_moved = self.folded.landed.distances_to(points) <= _MOVED_M
        gone = self.folded.astray(float(row[3]), float(row[4])).apply(points) - points
        gone[np.abs(self.folded.line.left_distances(points)) <= _MOVED_M] /= 2.0
        return np.where(is_moved[:, None], gone, 0.0)
