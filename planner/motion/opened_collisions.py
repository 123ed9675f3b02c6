"""The collisions of a robot whose fingers are open more or less."""

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.table import Table
from planner.geometry.tolerance import LENGTH_M
from planner.motion.hand_holds import HandHold
from planner.robots.armed_robot import ArmedRobot
from planner.robots.card import EDGE_OPEN_M, HELD_M, OPENING_M, JointLayout
from planner.robots.collision.collisions import Collisions

_OPENINGS_M = np.array([HELD_M, EDGE_OPEN_M, OPENING_M])
"""The openings up to which fingers are compared (m), in rising order."""


class OpenedCollisions:
    """The collisions of a robot at a table. Threads may share it.

    Attributes:
        wide: those with fingers open as far as they ever are.
    """

    def __init__(self, machine: ArmedRobot, table: Table, torso_m: float, margin_m: float = 0.0) -> None:
        """Put the robot at a table with its lift raised (m); what is nearer than a margin (m) counts as touching."""
        self._layout = JointLayout.of(machine.card)
        self._up_to = tuple(
            machine.collisions(table, torso_m, opening_m=float(opening_m), margin_m=margin_m)
            for opening_m in _OPENINGS_M
        )
        self.wide = self._up_to[-1]

    def up_to(self, opening_m: float) -> Collisions:
        """Return the collisions of a robot with fingers open up to an opening (m)."""
        return self._up_to[int(np.searchsorted(_OPENINGS_M[:-1], opening_m - LENGTH_M))]

    def of(self, hold: HandHold, *, is_open: bool) -> Collisions:
        """Return the collisions of a hand that holds, or that comes to its grip or leaves it with open fingers."""
        held, edge, wide = self._up_to
        if hold.is_narrow:
            return edge if is_open else held
        return wide if is_open else edge

    def is_path_free(self, bases: FloatArray, joints: FloatArray, openings_m: FloatArray) -> bool:
        """Return whether nothing touches along a path, from one configuration to the next.

        Args:
            bases: the base's pose at each, shape (n, 3).
            joints: all arms' joints (rad), shape (n, joints).
            openings_m: how far each arm's fingers are open at most (m), shape (n, arms).
        """
        levels = np.searchsorted(_OPENINGS_M[:-1], openings_m - LENGTH_M)
        # On the line on which fingers open or close they are open as far as at its end where they are narrower.
        ends = 1 + np.flatnonzero((levels[1:] != levels[:-1]).any(axis=1))
        runs = zip([0, *ends], [*ends, len(levels)], strict=True)
        parts = [(first, last, levels[first]) for first, last in runs]
        parts += [(end - 1, end + 1, np.minimum(levels[end - 1], levels[end])) for end in ends]
        return all(self._is_free(bases[i:j], joints[i:j], opened.tolist()) for i, j, opened in parts)

    def _is_free(self, bases: FloatArray, joints: FloatArray, levels: list[int]) -> bool:
        """Return whether a path is free on which each arm's fingers are open up to one of the openings."""
        least, most = min(levels), max(levels)
        if not self._up_to[least].is_path_free(bases, joints):
            return False
        if least == most:
            return True
        wider = (arm for arm, level in enumerate(levels) if level > least)
        return bool(self._up_to[most].arms_apart(tuple(self._layout.arms), joints).all()) and all(
            self._up_to[levels[arm]].is_arm_path_free(arm, bases, joints[:, self._layout.spans[arm]]) for arm in wider
        )
