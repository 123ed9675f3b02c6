"""The PR2's implementation of the reach that the primitives ask for, with the shortfall of places out of reach.

Plans use only places within the comfort radius. How far a place falls short is computed once there is no plan, for
explanations and to tell what is hopeless.
"""

import math
from dataclasses import replace
from time import thread_time

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.pose import FloatArray
from planner.geometry.shortfall import Shortfall
from planner.geometry.tolerance import LENGTH_M, grid_keys
from planner.robots.approaches import APPROACHES, mirror_images
from planner.robots.arm import numbers_of
from planner.robots.arm_gap import least_gaps
from planner.robots.comfort_memories import Memories
from planner.robots.minimax import minimax, ranked
from planner.robots.mirrored_arm import MirroredArm
from planner.robots.nearest_comfort import PIECE_QUERIES
from planner.robots.posture_room import Room
from planner.robots.queried_arms import QueriedArms
from planner.robots.reach_query import ReachQuery
from planner.robots.shortfall import DIRECTIONS, FURTHEST_M, left_shortfall
from planner.robots.shortfall_reach import ShortfallReach


class Pr2Reach(ShortfallReach):
    """The reach of a PR2; see `ShortfallReach`."""

    def __init__(
        self,
        arm_names: tuple[str, ...],
        arms: tuple[MirroredArm, ...],
        torso_m: float,
        comfort_m: float,
        room: Room | None = None,
        memories: Memories | None = None,
    ) -> None:
        """Start with nothing asked.

        Args:
            arm_names: the arms from left to right.
            arms: the same arms.
            torso_m: how far the torso is raised (m).
            comfort_m: the comfort radius (m).
            room: the obstacles to the left arm's postures; None: the body is no obstacle.
            memories: what earlier plans with the same arms, torso, radius and room have learned; None: nothing.
        """
        self._arms = arms
        images, numbers = mirror_images(), numbers_of(arms[0].shape)
        self._labels = tuple(1 + (images if arm.is_mirrored else np.arange(len(APPROACHES))) for arm in arms)
        asked = QueriedArms(arm_names, arms, numbers, APPROACHES, self._labels)
        super().__init__(asked, torso_m, comfort_m, room, memories)

    def at_least_short(
        self, arm: int, ways: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> FloatArray:
        """Return a lower bound in closed form, which takes no query, on each way's shortfall (see `Shortfalls`)."""
        mirrored, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        places = mirrored.mirrored_places(ways) - mirrored.shoulder(self._torso_m)
        return np.asarray(least_gaps(mirrored.shape, places, self._axes[seen], count, float(step_m), self._comfort_m))

    def _least_shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float,
        deadline: Deadline,
    ) -> tuple[Shortfall, int]:
        mirrored, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        on_grid = self._from_shoulder(mirrored, points)
        found, queries = left_shortfall(mirrored.shape, self._wanted(seen), on_grid, at_most_m, deadline)
        x, y, z = mirrored.mirrored_places(np.array(found.towards))
        approach = int(approaches[found.approach])
        return replace(found, towards=(float(x), float(y), float(z)), approach=approach), queries

    def shortfall_together(
        self,
        arm: int,
        places: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> tuple[int, Shortfall] | None:
        """Return the worst of places that one approach must reach, in the best approach for it (see `Shortfalls`)."""
        mirrored, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        started = thread_time()
        on_grid = self._from_shoulder(mirrored, places)
        furthest = min(at_most_m, FURTHEST_M)
        query = self._wanted(seen)
        ranking, found = ranked(mirrored.shape, query, on_grid)
        while True:
            found = minimax(mirrored.shape, query, on_grid, DIRECTIONS, furthest, ranking, found, PIECE_QUERIES)
            is_cut_short = found.examined < len(ranking.order)
            if not is_cut_short or deadline.is_long_over:
                break
        self._query_time_s += thread_time() - started
        nearest = approaches[found.approach : found.approach + 1]
        if found.place >= 0:
            short = self.shortfall(arm, places[found.place], nearest)
            return None if short is None else (int(found.place), short)
        if math.isfinite(found.short_m):
            return None
        if is_cut_short or furthest < FURTHEST_M:
            known = float(ranking.bounds.min()) if is_cut_short else furthest
            return 0, Shortfall("too_far", None, known, True, (1.0, 0.0, 0.0), int(nearest[0]), 0)
        each = [(number, self.shortfall(arm, place, nearest, furthest)) for number, place in enumerate(places)]
        worst, short = max(((n, f) for n, f in each if f is not None), key=lambda pair: pair[1].short_by_m)
        return worst, replace(short, short_by_m=max(short.short_by_m, furthest), is_at_least=True)

    def _wanted(self, seen: NDArray[np.int64]) -> ReachQuery:
        """Return the requirements on a place to be reached in one of some approaches, as the left arm sees them."""
        return ReachQuery(self._axes[seen], seen + 1, self._comfort_m, self._room)

    def _from_shoulder(self, mirrored: MirroredArm, points: FloatArray) -> FloatArray:
        """Return points on the grid, as seen from the left arm's shoulder (m)."""
        on_grid = LENGTH_M * grid_keys(mirrored.mirrored_places(points))
        return np.asarray(on_grid - mirrored.shoulder(self._torso_m))

    def _as_left_arm_sees(self, arm: int, approaches: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.asarray(self._labels[arm][approaches] - 1)
