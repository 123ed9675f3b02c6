"""Decide whether the cloth can be brought to where a reason says that it lay.

The relaxation that quickly proves that a fold is impossible lets the article lie wherever drags lead and lets the hands
hold whatever a drag could have left them with, whether or not the robot can make those drags. A reason must not, since
a person would try in vain to repair it there. So a place counts only if the search reached it, or if one drag leads to
it from the start or from a place that the search reached.
"""

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Point2
from planner.geometry.tolerance import LENGTH_M, grid_key, grid_keys
from planner.primitives.context import Context
from planner.primitives.drag_grips import drag_covers, dragged, longest_drag, towards_robot
from planner.primitives.g_drag import GDrag
from planner.primitives.obstacle import Attempt, Situation, situation
from planner.primitives.state import State

_START = (0.0, 0.0)
"""The offset of cloth that has not been dragged (m)."""

_Place = tuple[int, int]
"""A place of the cloth in steps of the grid."""

_AS_ONE = np.array([1 << 32, 1])
"""The weights that turn a place on the grid into one number."""


class Places:
    """Decides whether situations can be brought about; keeps the answers."""

    def __init__(self, context: Context, reached: Collection[Situation]) -> None:
        """Prepare the decision from the situations that the search reached."""
        self._context = context
        self._everywhere = (1 << context.standoffs) - 1
        self._drags = GDrag(context)
        counts = np.arange(1, longest_drag(context) + 1)[:, None]
        self._shifts = tuple(
            grid_keys(counts * np.array(dragged(context, _START, station, 1)))
            for station in range(len(context.scene.stations))
        )
        self._origins_at: dict[int, dict[_Place, Point2]] = {}
        self._able: dict[tuple[int, int | None], NDArray[np.int64]] = {}
        self._led_to: dict[tuple[int, int, _Place, int], tuple[State, ...]] = {}
        self._taken: dict[tuple[int, int], frozenset[tuple[_Place, ...]]] = {}
        self._reached: dict[tuple[object, ...], dict[_Place, int]] = {}
        for done, x, y, held, is_dragged, standoff in reached:
            at = self._reached.setdefault((done, held, is_dragged), {})
            at[(x, y)] = at.get((x, y), 0) | (1 << standoff if held else self._everywhere)

    def worth_trying(self, attempt: Attempt) -> NDArray[np.int64]:
        """Return the indices of an attempt's places that may have `stands`; a quick first check."""
        state = attempt.state
        able = [_as_one(np.array(list(self._reached_in(state)), dtype=np.int64))]
        if not state.held:
            able.append(self._led_to_by_any(state.done, None))
        elif self._is_taken(state):
            able.append(self._led_to_by_any(state.done, state.station))
        keys = grid_keys(attempt.places)
        return np.flatnonzero(np.isin(_as_one(keys), np.concatenate(able)))

    def stands(self, state: State) -> int:
        """Return the standoffs at which the base may be in a state's situation, as a bit mask.

        The mask is 0 where the situation cannot be brought about. With free hands the base may be anywhere.
        """
        reached = self._reached_in(state).get(_key(state.offset), 0)
        if state.held:
            return reached | self._left_by_drags(state.station, state)
        if reached or _key(state.offset) == _key(_START):
            return self._everywhere
        stations = range(len(self._context.scene.stations))
        return self._everywhere if any(self._left_by_drags(station, state) for station in stations) else 0

    def _reached_in(self, state: State) -> dict[_Place, int]:
        """Return the places that the search reached with the folds done and the grips of a state."""
        done, _, _, held, is_dragged, _ = situation(state)
        return self._reached.get((done, held, is_dragged), {})

    def _origins(self, done: int) -> dict[_Place, Point2]:
        """Return where the cloth may lie free before a drag, on the grid and in m, the start first."""
        if done not in self._origins_at:
            free = [_key(_START), *self._reached.get((done, (), False), {})]
            self._origins_at[done] = {(x, y): (x * LENGTH_M, y * LENGTH_M) for x, y in free}
        return self._origins_at[done]

    def _led_to_by_any(self, done: int, station: int | None) -> NDArray[np.int64]:
        """Return where the cloth may lie free, or after one drag from a station, each place as one number.

        A station of None stands for any station.
        """
        key = (done, station)
        if key not in self._able:
            shifts = np.vstack(self._shifts if station is None else self._shifts[station : station + 1])
            origins = np.array(list(self._origins(done)), dtype=np.int64)
            led_to = (origins[:, None] + shifts[None]).reshape(-1, 2)
            self._able[key] = np.unique(_as_one(np.vstack([led_to, origins[:1]]) if station is None else led_to))
        return self._able[key]

    def _is_taken(self, state: State) -> bool:
        """Return whether a drag from the start, made at a state's station, takes the grips that the state holds."""
        key = (state.done, state.station)
        if key not in self._taken:
            towards = towards_robot(self._context, state.station)
            covers = drag_covers(self._context, state.done, _START, towards).covers
            self._taken[key] = frozenset(tuple(sorted(_key(grip) for grip in cover)) for cover in covers)
        return tuple(sorted(_key(held.point) for held in state.held)) in self._taken[key]

    def _left_by_drags(self, station: int, state: State) -> int:
        """Return the standoffs at which drags from a station leave the base when they lead to a state's situation."""
        origins = self._origins(state.done)
        for number, (x, y) in enumerate(_key(state.offset) - self._shifts[station]):
            before = origins.get((int(x), int(y)))
            found = 0 if before is None else self._left_by_drag(before, station, number + 1, state)
            if found:
                return found
        return 0

    def _left_by_drag(self, before: Point2, station: int, count: int, state: State) -> int:
        key = (state.done, station, _key(before), count)
        if key not in self._led_to:
            drags = self._drags.by(State(state.done, before, station, 0), count)
            self._led_to[key] = tuple(step.after for step in drags)
        held = tuple(h.key for h in state.held)
        ends = {after.standoff for after in self._led_to[key] if tuple(h.key for h in after.held) == held}
        return sum(1 << end for end in ends)


def _key(place: Point2) -> _Place:
    """Round a place to the grid, since dragging to and fro changes the last digits."""
    return (grid_key(place[0]), grid_key(place[1]))


def _as_one(places: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return places on the grid, shape (n, 2), as one number each."""
    return np.asarray(places.reshape(-1, 2) @ _AS_ONE)
