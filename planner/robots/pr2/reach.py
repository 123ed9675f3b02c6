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
from planner.geometry.driving import STANDOFF_STEP_M
from planner.geometry.pose import Approach, FloatArray
from planner.geometry.reach_query import ReachQuery, Shortfall
from planner.geometry.tolerance import LENGTH_M, grid_keys
from planner.robots.comfort_reach import ComfortReach, Memories, QueriedArms
from planner.robots.displacements import DIRECTIONS, FURTHEST_M
from planner.robots.pr2.arm import numbers_of
from planner.robots.pr2.arm_gap import least_gaps
from planner.robots.pr2.closed_comfort import ClosedArm, no_hints
from planner.robots.pr2.minimax import minimax, ranked
from planner.robots.pr2.mirrored_arm import MirroredArm
from planner.robots.pr2.nearest_comfort import PIECE_QUERIES
from planner.robots.pr2.posture_room import Room, no_walls
from planner.robots.pr2.requirements import Requirements
from planner.robots.pr2.shortfall import left_shortfall

_PITCHES_DEG = (15, 30, 45, 60)
_HEADINGS_DEG = (-120, *range(-90, 91, 15), 120)

APPROACHES = (
    *(Approach(math.radians(heading), math.radians(pitch)) for pitch in _PITCHES_DEG for heading in _HEADINGS_DEG),
    Approach(0.0, math.pi / 2),
)
"""Directions from which a gripper may pinch: a fan at four pitches, and straight down.

A hand that reaches back, beyond 90 degrees, leaves the other one room: without it, one of four random garments needs a
drag or a drive more. Finer steps there, or hands that reach back further, made no plan quicker but searches longer.
"""


def mirror_images() -> NDArray[np.int64]:
    """Return for each approach the index of its mirror image, shape (len(APPROACHES),)."""
    fan = len(_HEADINGS_DEG)
    inner = [index - index % fan + fan - 1 - index % fan for index in range(len(APPROACHES) - 1)]
    return np.array([*inner, len(APPROACHES) - 1], dtype=np.int64)


class Pr2Reach(ComfortReach):
    """The reach of a PR2; see `ComfortReach`."""

    def __init__(
        self,
        arm_names: tuple[str, ...],
        arms: tuple[MirroredArm, ...],
        torso_m: float,
        comfort_m: float,
        room: Room | None = None,
        memories: Memories | None = None,
    ) -> None:
        """Start with nothing remembered.

        Args:
            arm_names: the arms from left to right.
            arms: the same arms.
            torso_m: how far the torso is raised (m).
            comfort_m: the comfort radius (m).
            room: the obstacles to the left arm's postures; None: the body is no obstacle.
            memories: what earlier plans with the same arms, torso, radius and room have learned; None: nothing.
        """
        self._arms = arms
        images = mirror_images()
        self._labels = tuple(1 + (images if arm.is_mirrored else np.arange(len(APPROACHES))) for arm in arms)
        self._arm = ClosedArm(
            numbers_of(arms[0].shape),
            arms[0].shoulder(torso_m),
            np.array([approach.rotation[:, 0] for approach in APPROACHES]),
            no_hints(len(APPROACHES)),
            no_walls() if room is None else room._replace(poses=room.poses.copy()),
        )
        queried = QueriedArms(arm_names, arms, self._arm, APPROACHES, self._labels)
        super().__init__(queried, torso_m, comfort_m, memories)

    def at_least_short(self, ways: ReachQuery) -> FloatArray:
        """Return a lower bound in closed form on each way's shortfall (see `Reach`)."""
        mirrored = self._arms[ways.arm]
        places = mirrored.mirrored_places(ways.points) - mirrored.shoulder(self.torso_m)
        axes = self._arm.axes[self._as_left_arm_sees(ways)]
        return np.asarray(least_gaps(mirrored.shape, places, axes, ways.count, STANDOFF_STEP_M, self.comfort_m))

    def _least_shortfall(self, place: ReachQuery, at_most_m: float, deadline: Deadline) -> tuple[Shortfall, int]:
        mirrored, query = self._arms[place.arm], self._required(place)
        on_grid = self._from_shoulder(mirrored, place.points)
        found, queries = left_shortfall(mirrored.shape, query, on_grid, at_most_m, deadline)
        x, y, z = mirrored.mirrored_places(np.array(found.towards))
        approach = int(place.approaches[found.approach])
        return replace(found, towards=(float(x), float(y), float(z)), approach=approach), queries

    def _shortfall_together(self, places: ReachQuery, at_most_m: float, deadline: Deadline) -> Shortfall | None:
        mirrored, query = self._arms[places.arm], self._required(places)
        started = thread_time()
        on_grid = self._from_shoulder(mirrored, places.points)
        furthest = min(at_most_m, FURTHEST_M)
        ranking, found = ranked(mirrored.shape, query, on_grid)
        while True:
            found = minimax(mirrored.shape, query, on_grid, DIRECTIONS, furthest, ranking, found, PIECE_QUERIES)
            is_cut_short = found.examined < len(ranking.order)
            if not is_cut_short or deadline.is_long_over:
                break
        self.memory.charge(thread_time() - started)
        nearest = places.approaches[found.approach : found.approach + 1]
        if found.place >= 0:
            return self._shortfall_of(places, int(found.place), nearest, math.inf, ENDLESS)
        if math.isfinite(found.short_m):
            return None
        if is_cut_short or furthest < FURTHEST_M:
            known = float(ranking.bounds.min()) if is_cut_short else furthest
            return Shortfall("too_far", None, known, True, (1.0, 0.0, 0.0), int(nearest[0]), 0)
        numbers = range(len(places.points))
        each = [self._shortfall_of(places, number, nearest, furthest, ENDLESS) for number in numbers]
        short = max((one for one in each if one is not None), key=lambda one: one.short_by_m)
        return replace(short, short_by_m=max(short.short_by_m, furthest), is_at_least=True)

    def _required(self, places: ReachQuery) -> Requirements:
        """Return the requirements on places to be reached in one of some approaches, as the left arm sees them."""
        seen = self._as_left_arm_sees(places)
        return Requirements(self._arm.axes[seen], seen + 1, self.comfort_m, self._arm.room)

    def _from_shoulder(self, mirrored: MirroredArm, points: FloatArray) -> FloatArray:
        """Return points on the grid, as seen from the left arm's shoulder (m)."""
        on_grid = LENGTH_M * grid_keys(mirrored.mirrored_places(points))
        return np.asarray(on_grid - mirrored.shoulder(self.torso_m))

    def _as_left_arm_sees(self, query: ReachQuery) -> NDArray[np.int64]:
        return np.asarray(self._labels[query.arm][query.approaches] - 1)
