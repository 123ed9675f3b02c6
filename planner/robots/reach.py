"""The PR2's implementation of the reach that the primitives ask for, with the shortfall of places out of reach.

Plans use only places within the comfort radius. How far a place falls short is computed once there is no plan, for
explanations and to tell what is hopeless.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from time import thread_time

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.shortfall import Shortfall, never
from planner.geometry.tolerance import LENGTH_M
from planner.robots.approaches import APPROACHES, mirror_images
from planner.robots.arm import numbers_of
from planner.robots.arm_gap import least_gaps
from planner.robots.comfort_memories import Memories
from planner.robots.comfort_reach import AskedArms, ComfortReach
from planner.robots.least_worst import least_worst, ranked
from planner.robots.nearest_comfort import PIECE_QUERIES, Wanted
from planner.robots.posture_room import Room
from planner.robots.shortfall import DIRECTIONS, FURTHEST_M, left_shortfall
from planner.robots.sided_arm import SidedArm


class Pr2Reach(ComfortReach):
    """The reach of a PR2 with its torso at one height, for one comfort radius: see `ComfortReach`."""

    def __init__(
        self,
        arm_names: tuple[str, ...],
        arms: tuple[SidedArm, ...],
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
        asked = AskedArms(arm_names, arms, numbers, APPROACHES, self._labels)
        super().__init__(asked, torso_m, comfort_m, room, memories)

    def at_least_short(
        self, arm: int, ways: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> FloatArray:
        """Return a lower bound on the result of `shortfall_together` for the points of each way (m), shape (n,).

        The bound is in closed form, and so makes no query.

        Args:
            arm: index into `arm_names`.
            ways: tool points in the base frame at standoff 0 (m), shape (n, p, 3).
            approaches: indices into `approaches`, shape (k,); the best of them counts.
            count: the number of standoffs; the best of them counts.
            step_m: the distance between standoffs (m).
        """
        sided, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        places = sided.mirrored_places(ways) - sided.shoulder(self._torso_m)
        return np.asarray(least_gaps(sided.shape, places, self._axes[seen], count, float(step_m), self._comfort_m))

    def shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        is_over: Callable[[], bool] = never,
    ) -> Shortfall | None:
        """Return why, and by how much, a place is not within the comfort radius, in the best of some approaches.

        Displacements up to 0.8 m are tried, along eight horizontal directions, straight down and straight up.

        Args:
            arm: index into `arm_names`.
            points: the tool's position as seen from each of the places where the base may stand (m), shape (n, 3).
            approaches: indices into `approaches`, shape (k,); raises `ValueError` if there are none.
            at_most_m: the longest displacement tried (m), if less than that.
            is_over: once it returns true, what is known after a tenth of a second is the answer.

        Returns:
            The smallest shortfall, or a lower bound where it is over before any is found; None where the place is
            within the comfort radius from somewhere.
        """
        if len(approaches) == 0:
            raise ValueError("without an approach no point is within reach")
        points = np.reshape(points, (-1, 3))
        if self.from_anywhere(arm, points, approaches, 1, 0.0).any():
            return None
        started = thread_time()
        sided, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        on_grid = self._from_shoulder(sided, points)
        found, queries = left_shortfall(sided.shape, self._wanted(seen), on_grid, at_most_m, is_over)
        x, y, z = sided.mirrored_places(np.array(found.towards))
        self._shortfall_queries += queries
        self._query_time_s += thread_time() - started
        return replace(found, towards=(float(x), float(y), float(z)), approach=int(approaches[found.approach]))

    def shortfall_together(
        self,
        arm: int,
        places: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        is_over: Callable[[], bool] = never,
    ) -> tuple[int, Shortfall] | None:
        """Return the worst of places that are all to be reached in one approach, in the best approach for it.

        Args:
            arm: index into `arm_names`.
            places: places of the tool, each as seen from each of the places where the base may stand (m), shape (p, n,
                3).
            approaches: indices into `approaches`, shape (k,), at least one.
            at_most_m: the longest displacement tried (m).
            is_over: once it returns true, only the approaches examined by then count.

        Returns:
            The place's index, and its shortfall in that approach; None where some approach brings all within the
            comfort radius. Where the shortfall is `at_most_m` or more, or only a lower bound, only this fact is
            meaningful.
        """
        sided, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        started = thread_time()
        on_grid = self._from_shoulder(sided, places)
        furthest = min(at_most_m, FURTHEST_M)
        wanted = self._wanted(seen)
        ranking, found = ranked(sided.shape, wanted, on_grid)
        while True:
            found = least_worst(sided.shape, wanted, on_grid, DIRECTIONS, furthest, ranking, found, PIECE_QUERIES)
            is_cut_short = found.examined < len(ranking.order)
            if not is_cut_short or is_over():
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

    def _wanted(self, seen: NDArray[np.int64]) -> Wanted:
        """Return the requirements on a place to be reached in one of some approaches, as the left arm sees them."""
        return Wanted(self._axes[seen], seen + 1, self._comfort_m, self._room)

    def _from_shoulder(self, sided: SidedArm, points: FloatArray) -> FloatArray:
        """Return points on the grid, as seen from the left arm's shoulder (m)."""
        on_grid = LENGTH_M * np.round(sided.mirrored_places(points) / LENGTH_M)
        return np.asarray(on_grid - sided.shoulder(self._torso_m))

    def _as_left_arm_sees(self, arm: int, approaches: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.asarray(self._labels[arm][approaches] - 1)
