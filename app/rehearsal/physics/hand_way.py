"""The way of one hand through a step, with the cloth that it holds."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from app.rehearsal.finger_ends import reach_ahead
from app.rehearsal.physics.fingers import Box, FingerSize, around
from app.rehearsal.physics.held_cloth import HeldCloth
from app.rehearsal.physics.pinch import clamped, fingertip, pinched
from app.rehearsal.world import GripMotion, way_done
from planner.geometry.pose import FloatArray
from planner.geometry.table import TableTop

_STILL_M = 1e-3
"""The horizontal distance below which a hand counts as turning nothing over (m)."""


@dataclass(frozen=True, eq=False)
class HandWay:
    """The way of one hand.

    Attributes:
        grip: its motion.
        held: the cloth between its fingers at the start.
        is_fold: whether that is turned over on the way.
        top: the table's top, beside which cloth hangs.
        under_m: the thickness of the finger under the cloth (m).
        rise_m: how much higher than its path the hand ends (m).
    """

    grip: GripMotion
    held: HeldCloth
    is_fold: bool
    top: TableTop
    under_m: float = 0.01
    rise_m: float = 0.0

    def landing_on(self, height_m: float) -> "HandWay":
        """Return the way raised so that the lowest cloth in the hand ends at a height or above it (m).

        The path knows no thickness: it would press the cloth into the stack on which it comes to lie. A hand whose
        fingers are one over the other has one under the cloth, and so has any that holds on: without that, edges that
        met were hooked, and the stack was lifted too.
        """
        end_s = self.grip.times_s[-1]
        height_m += 0.0 if self.grip.opens and self.grip.heading_rad is None else self.under_m
        lowest = fingertip(self.grip.at(end_s))[2] + self.held_at(end_s).lowest_m
        return replace(self, rise_m=max(0.0, height_m - float(lowest)))

    def held_at(self, t_s: float) -> HeldCloth:
        """Return the cloth between the fingers at a time since the step's start (s)."""
        if not self.is_fold or self._ahead is None:
            return self.held
        done = float(np.interp(t_s, self.grip.times_s, self._done))
        if self._round_m and not self.held.hangs:
            turned = self.held.turned_round(self._ahead, self._round_m, done * self._turn_rad)
        else:
            turned = self.held.turned(self._ahead, self.grip.turned_at(t_s), done * self._turn_rad)
        turned = replace(turned, hangs=self._ends_hanging)
        return turned.raised(self.rise_m * max(0.0, 2.0 * done - 1.0))  # from the apex on

    def at(self, t_s: float) -> dict[int, FloatArray]:
        """Return the place of each vertex held at a time since the step's start (s), shape (3,), m."""
        return self.held_at(t_s).at(fingertip(self.grip.at(t_s)))

    def fingers_at(self, t_s: float, size: FingerSize, open_m: float = 0.0) -> list[Box]:
        """Return where the fingers are at a time since the step's start (s), `open_m` from closed; none if unknown."""
        held = self.held_at(t_s)
        if self.grip.heading_rad is None or held.hangs:
            return []
        roll_rad = self.grip.turned_at(t_s) if self.is_fold and self._ahead is not None else 0.0
        way = np.zeros(2) if self._ahead is None else self._ahead
        closing = np.array([*(math.sin(roll_rad) * way), math.cos(roll_rad)])
        return around(fingertip(self.grip.at(t_s)) + held.between, closing, self.grip.heading_rad, size, open_m)

    @cached_property
    def _ahead(self) -> FloatArray | None:
        return ahead(self.grip)

    @cached_property
    def _round_m(self) -> float:
        """How far ahead on its way are the ends of the fingers round which cloth turns over (m); 0 if it does not."""
        return reach_ahead(self.grip)

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


def pinched_by(
    grip: GripMotion, positions: FloatArray, triangles: NDArray[np.int64], top: TableTop, clear_m: float
) -> dict[int, FloatArray]:
    """Return the vertices that a hand holds once it has closed at the start of its motion; see `pinched`."""
    tool, way = grip.at(grip.times_s[0]), ahead(grip)
    found = pinched(positions, triangles, tool, top, clear_m, grip.layers)
    return found if way is None else clamped(found, positions, triangles, fingertip(tool), way)


def ahead(grip: GripMotion) -> FloatArray | None:
    """Return the direction of a hand's way on the ground, of length 1, shape (2,); None if it goes nowhere."""
    shift = np.subtract(grip.points[-1][:2], grip.points[0][:2])
    length = float(np.linalg.norm(shift))
    return None if length < _STILL_M else np.asarray(shift / length)
