"""How long moves take by the standoff from which they leave, and where the base should stand before one.

Folds and drags begin with driving to where they are done, so before them a standoff to which the base can drive on in
time is no worse than one where it stands already. Before a move it may be worse: the leg that backs out goes from rest
to rest, and the base turns where that ends. So a standoff that leaves no such leg, or a shorter way round the table,
may save more than the driving there takes.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.state import State


class MoveTimes:
    """The moves of one task, by station and standoff."""

    def __init__(self, context: Context) -> None:
        """Start with nothing computed: most plans never ask."""
        self._context = context
        self._moves = context.kept(BaseMove)
        self._all_done = (1 << len(context.sequence.folds)) - 1
        self._known: dict[int, FloatArray] = {}
        self._at_least_s: dict[int, float] = {}

    def may_follow(self, done: int) -> bool:
        """Return whether a move may be of use after some folds (bit mask) are done."""
        return done != self._all_done and len(self._context.scene.stations) > 1

    def at_least_s(self, station: int) -> float:
        """Return a lower bound on the time of any move from a station (s); it is found much sooner than `least_s`."""
        if station not in self._at_least_s:
            goals = [goal for goal in range(len(self._context.scene.stations)) if goal != station]
            starts = range(self._context.standoffs)
            self._at_least_s[station] = min(
                self._moves.at_least_s(station, start, g) for g in goals for start in starts
            )
        return self._at_least_s[station]

    def least_s(self, station: int) -> FloatArray:
        """Return the time of the quickest move from each standoff of a station (s), shape (standoffs,)."""
        return np.asarray(self._durations_s(station).min(axis=0))

    def onward(self, station: int) -> NDArray[np.int64]:
        """Return by how many steps of driving one standoff must come before another to make it useless before a move.

        That is as many as the base drives from one to the other, and more where each of these is worth more than its
        time: shape (standoffs, standoffs).
        """
        context, durations_s = self._context, self._durations_s(station)
        places = np.arange(context.standoffs)
        saved_s = (durations_s[:, :, None] - durations_s[:, None, :]).max(axis=0)
        saved = np.ceil((saved_s - TIME_S) / context.drive_s(1)).astype(np.int64)
        return np.asarray(np.maximum(np.abs(places[:, None] - places), saved))

    def _durations_s(self, station: int) -> FloatArray:
        """Return the duration of the move to each other station from each standoff, shape (stations - 1, standoffs)."""
        if station not in self._known:
            starts = [State(0, (0.0, 0.0), station, standoff) for standoff in range(self._context.standoffs)]
            goals = [goal for goal in range(len(self._context.scene.stations)) if goal != station]
            durations_s = [[self._moves.to(start, goal)[0].duration_s for start in starts] for goal in goals]
            self._known[station] = np.array(durations_s)
        return self._known[station]
