"""The way of one hand through a step, with the cloth that it holds."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from app.physics.held_cloth import HeldCloth
from app.physics.pinch import fingertip
from app.rehearsal.world import GripMotion, way_done
from planner.geometry.pose import FloatArray
from planner.geometry.table_top import TableTop

UNDER_M = 0.01
"""The thickness of the finger under cloth that is held (m)."""

_STILL_M = 1e-3
"""The way on the ground below which a hand is taken to turn nothing over (m)."""


@dataclass(frozen=True, eq=False)
class HandWay:
    """The way of one hand.

    Attributes:
        grip: its motion.
        held: the cloth between its fingers at the start.
        is_fold: whether that is turned over on the way.
        top: the table's top, beside which cloth hangs.
        rise_m: how much higher than its path the hand ends (m).
    """

    grip: GripMotion
    held: HeldCloth
    is_fold: bool
    top: TableTop
    rise_m: float = 0.0

    def landing_on(self, height_m: float) -> "HandWay":
        """Return the way on which the lowest cloth in the hand ends at a height or above it (m).

        The path knows no thickness: it would press the cloth into the stack on which it comes to lie. A hand that holds
        on keeps a finger under the cloth; without that, edges that met were hooked, and the stack was lifted too.
        """
        end_s = self.grip.times_s[-1]
        height_m += 0.0 if self.grip.opens else UNDER_M
        lowest = fingertip(self.grip.at(end_s))[2] + self.held_at(end_s).lowest_m
        return replace(self, rise_m=max(0.0, height_m - float(lowest)))

    def held_at(self, t_s: float) -> HeldCloth:
        """Return the cloth between the fingers at a time since the step's start (s)."""
        if not self.is_fold or self._ahead is None:
            return self.held
        done = float(np.interp(t_s, self.grip.times_s, self._done))
        turned = self.held.turned(self._ahead, self.grip.turned_at(t_s), done * self._turn_rad)
        turned = replace(turned, hangs=self._ends_hanging)
        return turned.raised(self.rise_m * max(0.0, 2.0 * done - 1.0))  # from the apex on

    def at(self, t_s: float) -> dict[int, FloatArray]:
        """Return the place of each vertex held at a time since the step's start (s), shape (3,), m."""
        return self.held_at(t_s).at(fingertip(self.grip.at(t_s)))

    @cached_property
    def _ahead(self) -> FloatArray | None:
        return ahead(self.grip)

    @cached_property
    def _done(self) -> FloatArray:
        """The share of the way that is done at each point of the grip's motion."""
        return way_done(np.array(self.grip.points))

    @cached_property
    def _turn_rad(self) -> float:
        """The angle by which the cloth beside the fingers turns over: half a turn, more where it hangs.

        At the start it hangs where it hung when the fingers closed, wherever they have dragged it since.
        """
        hanging = int(self.held.hangs) + int(self._ends_hanging)
        return math.pi * (1.0 + 0.5 * hanging)

    @cached_property
    def _ends_hanging(self) -> bool:
        return not self.top.covers(np.array(self.grip.points[-1])[None])


def ahead(grip: GripMotion) -> FloatArray | None:
    """Return the direction of a hand's way on the ground, of length 1, shape (2,); None if it goes nowhere."""
    shift = np.subtract(grip.points[-1][:2], grip.points[0][:2])
    length = float(np.linalg.norm(shift))
    return None if length < _STILL_M else np.asarray(shift / length)
