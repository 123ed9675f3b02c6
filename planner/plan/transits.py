"""How free hands get from one configuration to another: straight in the space of the joints, or by way of a few places.

Free arms are mostly well over the table, and a straight line between two configurations is free. Where it is not, the
arms go one after the other, or by way of raised configurations.
"""

from collections.abc import Iterator
from itertools import pairwise, product

import numpy as np

from planner.geometry.pose import FloatArray, Pose2
from planner.plan.machine import Collisions, Machine
from planner.plan.pacing import needed_s

STEP_RAD = 0.05
"""Joints turn by no more than this from one place that is checked to the next (rad)."""


class Transits:
    """Finds ways for free hands."""

    def __init__(self, machine: Machine, collisions: Collisions) -> None:
        """Ways of one robot among what it may collide with."""
        arms = machine.card.arms
        self._collisions = collisions
        self._homes = np.array([machine.home(arm) for arm in range(len(arms))])
        self._speeds = np.array([arm.speeds_rad_s for arm in arms])
        self._turns = np.where([arm.is_continuous for arm in arms], 2.0 * np.pi, np.inf)

    @property
    def home(self) -> FloatArray:
        """All arms out of the way (rad), shape (arms, 7)."""
        return self._homes

    def needed_s(self, way: FloatArray) -> FloatArray:
        """The least time for each line of a way (s)."""
        return needed_s(way, self._speeds)

    def unwound(self, joints: FloatArray, near: FloatArray) -> FloatArray:
        """The same configuration, shape (arms, 7), its continuous joints within half a turn of another's."""
        turns = np.where(np.isinf(self._turns), 0.0, np.round((near - joints) / (2.0 * np.pi)))
        return np.asarray(joints + 2.0 * np.pi * turns)

    def way(self, base: Pose2, start: FloatArray, goal: FloatArray) -> FloatArray | None:
        """A way between two configurations while the base stands.

        Args:
            base: where it stands, table frame.
            start: all arms' joints (rad), shape (arms, 7).
            goal: the same; its continuous joints may be turns away.

        Returns:
            Configurations from start to goal, shape (n, arms, 7), between which straight lines are free; None if no
            way was found.
        """
        goal = self.unwound(goal, start)
        for places in self._by_way_of(start, goal):
            way = np.array([start, *places, goal])
            if all(self.is_free(base, a, b) for a, b in pairwise(way)):
                return way
        return None

    def is_free(self, base: Pose2, start: FloatArray, end: FloatArray) -> bool:
        """Whether the straight line between two configurations is free."""
        count = max(1, int(np.ceil(np.abs(end - start).max() / STEP_RAD)))
        shares = np.linspace(0.0, 1.0, count + 1)[:, None, None]
        return self._collisions.are_all_free(base, start + shares * (end - start))

    def _by_way_of(self, start: FloatArray, goal: FloatArray) -> Iterator[tuple[FloatArray, ...]]:
        """What to go by way of: nothing, then one place, then two, the nearest first."""
        yield ()
        raised_start, raised_goal = self._raised(start), self._raised(goal)
        mixed = [np.where(np.array(first)[:, None], goal, start) for first in product((False, True), repeat=len(start))]
        home = self.unwound(self._homes, start)
        singles = [*mixed[1:-1], raised_goal, raised_start, home]
        singles.sort(key=lambda place: float(self.needed_s(np.array([start, place, goal])).sum()))
        for place in singles:
            yield (place,)
        yield raised_start, raised_goal
        for place in mixed[1:-1]:
            yield raised_start, place
            yield place, raised_goal
        yield raised_start, home, raised_goal

    def _raised(self, joints: FloatArray) -> FloatArray:
        """Arms lifted as at home, their shoulders and hands turned as they are."""
        raised = joints.copy()
        raised[:, [1, 3]] = self._homes[:, [1, 3]]
        return raised
