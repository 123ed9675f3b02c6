"""The motion of cloth and grips in a g-fold (paper, section 6).

A baseline sweeps from the far end of the moving part to the fold line while the cloth beyond it stands vertically above
it, and goes on to lay the cloth down on the other side. Let D be the moving part's largest distance from the fold line,
and b the baseline's. A point at distance d rests until b = d, rises along (b, d - b) to the apex (0, d), comes down
along (-b, d - b) and rests. Every part is vertical or horizontal at every moment.
"""

import math
from dataclasses import dataclass

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.segment import Segment
from planner.geometry.table import TableTop
from planner.geometry.tolerance import LENGTH_M, SNAP_M

REST_HEIGHT_M = 0.02
"""The tool frame's height above the table's plane at rest, at least: closed fingertips just clear the table (m)."""

OVER_STACK_M = 0.012
"""How far the tool frame is above the stack that it takes or lays down, at least: a finger is as thick (m)."""

SPACING_M = 0.05
"""The largest distance between waypoints of a path (m)."""


_AT_ORIGIN = Pose2(0.0, 0.0, 0.0)

_WAY_IN_MAX_M = 0.04
"""The way in from outside an edge up to which waypoints are close enough (m); longer ones would need too many."""


@dataclass(frozen=True, slots=True)
class RestHeights:
    """The heights at which tools rest that take or lay down the edges of a stack.

    Attributes:
        cloth: the stack.
        thickness_m: the thickness of a layer between fingers (m).
    """

    cloth: ClothState
    thickness_m: float

    @property
    def raised_m(self) -> float:
        """How much higher than `REST_HEIGHT_M` tools rest at most (m)."""
        return rest_height_m(len(self.cloth.layers) * self.thickness_m) - REST_HEIGHT_M

    @property
    def are_even(self) -> bool:
        """Whether the whole stack is so low that tools rest at one height."""
        return self.raised_m == 0.0

    def at(self, points: FloatArray) -> FloatArray:
        """Return the heights over points of the garment frame, shape (n, 2) -> (n,), m."""
        if self.are_even:
            return np.full(len(points), REST_HEIGHT_M)
        is_there = [layer.region.distances_to(points) <= SNAP_M for layer in self.cloth.layers]
        return np.array([rest_height_m(self.thickness_m * count) for count in np.sum(is_there, axis=0).tolist()])


def rest_height_m(stack_m: float) -> float:
    """Return the tool frame's height above the table's plane at rest, at a stack of a height (m)."""
    return max(REST_HEIGHT_M, stack_m + OVER_STACK_M)


@dataclass(frozen=True, slots=True)
class FoldPath:
    """The motion of one fold at one placement.

    Attributes:
        line: the fold line in the table frame, unrolled plane.
        depth_m: the largest distance of the moving part from it, D (m).
        top: the table's top.
        rising_top: the top until the apex: cloth beyond an edge that starts out held at the table's height, not
            hanging, moves as if the table continued there.
        edge_clear_m: how far outside an edge's plane a tool holds cloth that hangs there (m).
        placement: the garment frame in the table frame.
        stacks: the heights at which tools rest before and after the fold; None where they are the same everywhere.
    """

    line: Segment
    depth_m: float
    top: TableTop
    rising_top: TableTop
    edge_clear_m: float = 0.0
    placement: Pose2 = _AT_ORIGIN
    stacks: tuple[RestHeights, RestHeights] | None = None

    def swept(self, points: FloatArray, sweep: float | FloatArray) -> FloatArray:
        """Return the positions of points of the moving part in the unrolled plane.

        Args:
            points: their positions before the fold, table frame, shape (n, 2), m.
            sweep: 0 all lies flat, 1 all stands above the fold line, 2 all is laid down; or several, shape (k, 1).

        Returns:
            Shape (n, 3), or (k, n, 3): position in the unrolled plane and height above it (m).
        """
        distances, moment = self.line.left_distances(points), np.asarray(sweep)
        flat = np.minimum(distances, self.depth_m * np.abs(1.0 - moment))
        shifts = np.where(moment <= 1.0, flat, -flat) - distances
        found = np.empty((*flat.shape, 3))
        found[..., :2] = points + shifts[..., None] * np.array(self.line.left)
        found[..., 2] = distances - flat
        return found

    def top_at(self, sweep: float) -> TableTop:
        """Return the top over which cloth does not hang at a sweep."""
        return self.rising_top if sweep < 1.0 else self.top

    def is_continuous(self, grips: FloatArray) -> bool:
        """Return whether all grips peak above the table, or no grip was held out beyond an edge.

        Cloth held out beyond an edge rises in the plane; it can come down over the table only if the fold line is on
        the table there.
        """
        return self.rising_top == self.top or not np.any(self.top.beyond(self.swept(grips, 1.0)) > LENGTH_M)

    def tool_points(self, grips: FloatArray, sweep: float) -> FloatArray:
        """Return the tools' positions for given points of the cloth, shape (n, 2) -> (n, 3), table frame (m)."""
        return self.tool_paths(grips, np.array([sweep]))[:, 0]

    def tool_paths(self, grips: FloatArray, sweeps: FloatArray) -> FloatArray:
        """Return the tools' positions at several sweeps, shape (n, 2) and (k,) -> (n, k, 3), table frame (m)."""
        unrolled = self.tools_unrolled(grips, sweeps)
        if self.rising_top == self.top:
            return self.over_edge(unrolled, self.top).transpose(1, 0, 2)
        rising, falling = unrolled[sweeps < 1.0], unrolled[sweeps >= 1.0]
        paths = np.concatenate([self.over_edge(rising, self.rising_top), self.over_edge(falling, self.top)])
        return paths.transpose(1, 0, 2)

    def tools_unrolled(self, grips: FloatArray, sweeps: FloatArray) -> FloatArray:
        """Return where tools are in the unrolled plane at several sweeps, shape (n, 2) and (k,) -> (k, n, 3), m.

        On its way a tool goes from the height at which it takes its stack to the height at which it lays it down.
        """
        found = self.swept(grips, sweeps[:, None])
        if self.stacks is None:
            found[..., 2] += REST_HEIGHT_M
            return found
        places = self.swept(grips, 2.0)[:, :2]
        picked, laid = (
            stack.at(self.placement.to_inner(points))
            for stack, points in zip(self.stacks, (grips, places), strict=True)
        )
        shares = np.clip(sweeps / 2.0, 0.0, 1.0)[:, None]
        found[..., 2] += picked + shares * (laid - picked)
        return found

    def over_edge(self, unrolled: FloatArray, top: TableTop) -> FloatArray:
        """Return the positions in space of tools of the unrolled plane, shape (..., 3), table frame (m).

        In the edge's plane the fingers would be inside the table. So a tool above hanging cloth keeps clear of the
        plane by `edge_clear_m`; on its way over the edge it approaches that distance gradually.
        """
        return top.clear_of_edge(unrolled, self.edge_clear_m, REST_HEIGHT_M)

    def sweeps(self, grips: FloatArray) -> FloatArray:
        """Return the sweeps at which grips are tested: rising, apex in the middle, at most 5 cm apart.

        Grips as far from the line as anything begin at 0 and end at 2, and not a rounding error before or after: else
        the base might have a motion of no length to itself.
        """
        farthest = float(self.line.left_distances(grips).max())
        count = max(1, math.ceil((farthest - LENGTH_M) / self._baseline_step(grips)))
        rising = 1.0 - np.linspace(farthest, 0.0, count + 1) / self.depth_m
        if abs(self.depth_m - farthest) <= LENGTH_M:
            rising[0] = 0.0
        return np.concatenate([rising, 2.0 - rising[-2::-1]])

    def _baseline_step(self, grips: FloatArray) -> float:
        """Return how far the baseline may go between waypoints (m).

        A tool goes sqrt(2) times as far as the baseline above the table and up to twice as far at an edge. Coming in
        from outside the edge takes it at most one step s, in which it travels the square root of (way in + s)^2 + s^2.
        """
        start, apex, end = self.swept(grips, np.array([[0.0], [1.0], [2.0]]))
        if self.top.covers(np.array([start, apex, end])):
            return SPACING_M / math.sqrt(2.0)
        if self.rising_top.covers(np.array([start, apex])) and self.top.covers(np.array([apex, end])):
            return SPACING_M / 2.0
        way_in_m = min(self.edge_clear_m, _WAY_IN_MAX_M)
        return min(SPACING_M / 2.0, (math.sqrt(2.0 * SPACING_M**2 - way_in_m**2) - way_in_m) / 2.0)
