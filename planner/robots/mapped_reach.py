"""The reach of a robot whose arms have reach maps, with the shortfall of places out of reach, compiled.

As for a closed form (`planner.robots.pr2.nearest_comfort`) the search goes outwards in shells, along all directions and
approaches and from all places of the base at once, and ends in the first shell that has a place within the radius.
Shells are thicker here, because each query takes longer, and what the arm's length rules out is not asked.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from planner.deadline import Deadline
from planner.geometry.driving import STANDOFF_STEP_M
from planner.geometry.pose import FloatArray, point3
from planner.geometry.reach_query import Cause, ReachQuery, Shortfall
from planner.kernels import kernel
from planner.robots.arm_query import ArmNumbers
from planner.robots.comfort_memories import Memories
from planner.robots.comfort_reach import ComfortReach, QueriedArms
from planner.robots.displacements import DIRECTIONS, FURTHEST_M, SIDEWAYS, homewards
from planner.robots.mapped_comfort import MappedArms, first_of, is_held_round, mapped_query, mapped_space
from planner.robots.newton import solve
from planner.robots.reach_map import cell_of, decode

Heights: TypeAlias = tuple[tuple[float, float], ...]
"""The lowest and the highest point of each arm's map, seen from its root (m)."""

Covering: TypeAlias = Callable[[int, FloatArray], tuple[MappedArms, Heights]]
"""Has an arm's map cover points that are seen from its root; returns all arms with their maps, and these' heights."""

_QUERIES_MAX = 50_000
"""Queries after which a shortfall is told as far as it is known: some tenths of a second."""

_QUERIES_LATE_MAX = 5_000
"""The same where nobody waits for the answer any more."""


class MappedReach(ComfortReach):
    """The reach of a robot whose arms have reach maps; see `ComfortReach`."""

    def __init__(
        self,
        asked: QueriedArms,
        heights: Heights,
        covering: Covering,
        joint_names: tuple[tuple[str, ...], ...],
        lengths_m: tuple[float, ...],
        torso_m: float,
        comfort_m: float,
        memories: Memories | None = None,
    ) -> None:
        """Start with nothing asked.

        Args:
            asked: the arms, with maps.
            heights: those that their maps cover.
            covering: has an arm's map cover more.
            joint_names: the joints of each arm.
            lengths_m: how far from its root each arm may reach (m).
            torso_m: how far the lift is raised (m).
            comfort_m: the comfort radius (m).
            memories: what earlier plans have learned; None: nothing.
        """
        super().__init__(asked, torso_m, comfort_m, memories)
        self._heights = heights
        self._covering = covering
        self._joint_names = joint_names
        self._lengths_m = lengths_m

    def _arms(self) -> MappedArms:
        """Return the arms with their maps."""
        return cast(MappedArms, self._asked.numbers)

    def _numbers_for(self, query: ReachQuery) -> ArmNumbers:
        """Return the arms with maps that cover some points."""
        seen = query.points - self._shoulders[query.arm]
        low_m, high_m = self._heights[query.arm]
        if seen.size and (seen[..., 2].min() < low_m or seen[..., 2].max() > high_m):
            numbers, self._heights = self._covering(query.arm, seen)
            self._asked = replace(self._asked, numbers=numbers)
        return self._asked.numbers

    def _searched_m(self, arm: int, seen: FloatArray, furthest_m: float) -> float:
        """Return how far points were displaced in every direction in which the arm's map or its length ends (m)."""
        searched_m = furthest_m
        for x, y, z in seen:
            for end_m in self._heights[arm]:
                if math.hypot(x, y, end_m) < self._lengths_m[arm]:
                    searched_m = min(searched_m, abs(end_m - z))
        return searched_m

    def at_least_short(self, ways: ReachQuery) -> FloatArray:
        """Return how far each way's points are beyond the arm's length from the best standoff (see `Reach`)."""
        ahead = np.arange(ways.count)[:, None] * np.array([STANDOFF_STEP_M, 0.0, 0.0])
        seen = (ways.points - self._shoulders[ways.arm])[:, :, None] + ahead
        away = np.linalg.norm(seen, axis=-1) - self._lengths_m[ways.arm] + self.comfort_m
        return np.asarray(np.maximum(away.min(axis=2).max(axis=1), 0.0))

    def _least_shortfall(self, place: ReachQuery, at_most_m: float, deadline: Deadline) -> tuple[Shortfall, int]:
        arm, approaches = place.arm, place.approaches
        seen, labels = place.points - self._shoulders[arm], self._asked.labels[arm][approaches]
        furthest = min(at_most_m, FURTHEST_M)
        most = _QUERIES_LATE_MAX if deadline.is_long_over else _QUERIES_MAX
        short_by_m, seen_from, approach, direction, queries = nearest_place(
            self._arms(), labels, seen, DIRECTIONS, self.comfort_m, furthest, most
        )
        is_at_least = seen_from < 0
        if is_at_least:
            distances = np.linalg.norm(seen, axis=1)
            seen_from, approach = int(distances.argmin()), 0
            searched = self._searched_m(arm, seen, furthest) if queries < most else 0.0
            short_by_m = max(float(distances.min()) - self._lengths_m[arm], searched)
        point = seen[seen_from]
        towards = homewards(point) if is_at_least else DIRECTIONS[direction]
        cause, comfort_m = "too_far" if is_at_least else _cause(point, towards, short_by_m), None
        widest_m, widest_from, _ = widest_circle(self._arms(), labels, seen, self.comfort_m)
        if widest_from >= 0:
            cause, comfort_m = "comfort_only", widest_m
        joint = joint_at_limit(self._arms(), int(labels[approach]), point)
        name = None if joint < 0 else self._joint_names[arm][joint]
        chosen = int(approaches[approach])
        found = Shortfall(cause, name, short_by_m, is_at_least, point3(towards), chosen, seen_from, comfort_m)
        return found, queries

    def _shortfall_together(self, places: ReachQuery, at_most_m: float, deadline: Deadline) -> Shortfall | None:
        each = [self.from_anywhere(replace(places, points=points, count=1)) for points in places.points]
        had = np.stack([one.any(axis=1) for one in each], axis=1)
        if had.all(axis=1).any():
            return None
        best: Shortfall | None = None
        for row in np.argsort(-had.sum(axis=1), kind="stable"):
            if best is not None and deadline.is_long_over:
                break
            limit_m = at_most_m if best is None else min(at_most_m, best.short_by_m)
            worst: Shortfall | None = None
            for number in np.flatnonzero(~had[row]).tolist():
                found = self._shortfall_of(places, number, places.approaches[row : row + 1], limit_m, deadline)
                if found is not None and (worst is None or found.short_by_m > worst.short_by_m):
                    worst = found
                if worst is not None and worst.short_by_m >= limit_m:
                    break
            if worst is not None and (best is None or worst.short_by_m < best.short_by_m):
                best = worst
        return best


def _cause(point: FloatArray, towards: FloatArray, short_by_m: float) -> Cause:
    """Return why a point, seen from the arm's root, is out of reach that a displacement brings into it."""
    further_m = np.linalg.norm(point + short_by_m * towards) - np.linalg.norm(point)
    if further_m < -SIDEWAYS * short_by_m:
        return "too_far"
    return "too_near" if further_m > SIDEWAYS * short_by_m else "joint_limit"


_SHELL_M, _WIDENING = 0.01, 0.06
"""Thickness of a shell (m), or as a fraction of its distance where that is more."""

_FINEST_M = 0.001
"""Precision at which the bisection ends (m)."""

_AT_LIMIT_RAD = 1e-3


@kernel
def nearest_place(
    arms: MappedArms,
    labels: NDArray[np.int64],
    points: FloatArray,
    directions: FloatArray,
    comfort: float,
    furthest: float,
    queries_max: int,
) -> tuple[float, int, int, int, int]:
    """Return the smallest displacement that brings a tool point within the comfort radius.

    Args:
        arms: the arms.
        labels: the labels of one arm's approaches that are allowed, shape (k,).
        points: the point as seen from the arm's root, from each place of the base, shape (n, 3), m.
        directions: unit vectors, shape (m, 3).
        comfort: the comfort radius (m).
        furthest: the furthest displacement searched (m).
        queries_max: the most queries; then what is known counts.

    Returns:
        The displacement (m), rounded up to a millimetre; the point; the approach; the direction; queries made.
        Infinity, -1, -1, -1 where there is none.
    """
    space, at = mapped_space(arms), np.empty(3)
    best, best_place, best_approach, best_direction, queries = math.inf, -1, -1, -1, 0
    inner = 0.0
    while inner < furthest and best_place < 0 and queries < queries_max:
        limit = outer = inner + max(_SHELL_M, _WIDENING * inner)
        for approach in range(len(labels)):
            ask = mapped_query(arms, labels[approach], comfort)
            for place in range(len(points)):
                beyond = math.sqrt((points[place] ** 2).sum()) - ask.length
                if beyond >= limit:
                    continue
                for direction in range(len(directions)):
                    near, far = inner, limit
                    if far <= near:
                        break
                    at[:] = points[place] + far * directions[direction]
                    if math.sqrt((at**2).sum()) > ask.length:
                        continue
                    queries += 1
                    if not is_held_round(ask, space, at):
                        continue
                    while far - near > _FINEST_M:
                        middle = 0.5 * (near + far)
                        at[:] = points[place] + middle * directions[direction]
                        queries += 1
                        if is_held_round(ask, space, at):
                            far = middle
                        else:
                            near = middle
                    best, best_place, best_approach, best_direction = far, place, approach, direction
                    limit = far - _FINEST_M
        inner = outer
    return best, best_place, best_approach, best_direction, queries


@kernel
def widest_circle(
    arms: MappedArms, labels: NDArray[np.int64], points: FloatArray, comfort: float
) -> tuple[float, int, int]:
    """Return the radius of the largest circle, up to `comfort` (m), on which the tool is still within reach.

    Returns:
        The radius (m), rounded down to a millimetre; the point; the approach. 0, -1, -1 where no point is within reach.
    """
    space = mapped_space(arms)
    best, best_place, best_approach = 0.0, -1, -1
    for approach in range(len(labels)):
        for place in range(len(points)):
            near, far = best, comfort
            if best_place >= 0 and far - near <= _FINEST_M:
                break
            if not is_held_round(mapped_query(arms, labels[approach], near), space, points[place].copy()):
                continue
            while far - near > _FINEST_M:
                middle = 0.5 * (near + far)
                if is_held_round(mapped_query(arms, labels[approach], middle), space, points[place].copy()):
                    near = middle
                else:
                    far = middle
            best, best_place, best_approach = near, place, approach
    return best, best_place, best_approach


@kernel
def joint_at_limit(arms: MappedArms, label: int, point: FloatArray) -> int:
    """Return the joint that keeps the tool from a point: at its limit where Newton's method gets no nearer; -1 if none.

    Among the postures of the point's cell, that of the first which ends at a limit.
    """
    ask = mapped_query(arms, label, 0.0)
    space, count = mapped_space(arms), len(ask.chain.low)
    joints, cell = space.middle[:count], cell_of(ask.known.grid, point)
    if cell < 0:
        return -1
    entry = cell * len(ask.known.grid.rotations) + ask.approach
    for number in range(ask.known.starts[entry], ask.known.starts[entry + 1]):
        decode(ask.known.grid, ask.known.postures[number], joints)
        solve(ask.chain, point, ask.rotation, ask.chain.rows, joints, first_of(space.newton, count))
        for i in range(count):
            nearest = min(joints[i] - ask.chain.low[i], ask.chain.high[i] - joints[i])
            if not ask.chain.turns[i] and nearest <= _AT_LIMIT_RAD:
                return i
    return -1
