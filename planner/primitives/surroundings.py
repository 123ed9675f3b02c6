"""Decide whether the cloth round a grip is the same whatever other folds are done."""

import networkx as nx

from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.primitives.context import Context

_BESIDE_M = 5e-3
"""The distance within which a part moved by another fold may change how a grip is approached (m)."""


class Surroundings:
    """For each grip of each fold, whether other folds change the cloth round it.

    Folds that must come before a fold are done whenever it is queried, and those that must come after it never are; all
    others may be done or not.
    """

    def __init__(self, context: Context) -> None:
        """Collect for each fold the folds that may be done or not; query no grip yet."""
        self._sequence = sequence = context.sequence
        self._known: dict[tuple[int, Point2], bool] = {}
        folds = range(len(sequence.folds))
        waits = nx.DiGraph(sequence.dag.edges)
        waits.add_nodes_from(folds)
        self._free = [set(folds) - nx.ancestors(waits, f) - nx.descendants(waits, f) - {f} for f in folds]

    def are_same(self, fold: int, grip: Point2) -> bool:
        """Return whether the cloth round a fold's grip, article frame, is the same after all sets of other folds."""
        if (fold, grip) not in self._known:
            self._known[fold, grip] = not any(self._is_beside(other, grip) for other in self._free[fold])
        return self._known[fold, grip]

    def _is_beside(self, fold: int, point: Point2) -> bool:
        """Return whether a point is close to the part that a fold moves, or to where that part lands."""
        part, line = self._sequence.moving(fold), self._sequence.folds[fold].line
        return _is_near(part, point) or _is_near(part, Isometry.reflection(line).apply_point(point))


def _is_near(region: Region, point: Point2) -> bool:
    return region.contains(point) or region.boundary_distance(point) <= _BESIDE_M
