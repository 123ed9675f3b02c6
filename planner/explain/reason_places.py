"""Whether the cloth can be brought to where a reason says that it lay.

The relaxation that proves a "no" quickly lets the article lie wherever drags lead and lets the hands hold whatever a
drag could have left them with, whether or not the robot can make those drags. A reason should not: a person would try
in vain to repair it there. So a place counts only if the search came to it, or one drag leads to it from the start or
from where the search came to.
"""

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Point2
from planner.geometry.tolerance import LENGTH_M, grid_key
from planner.primitives.context import Context
from planner.primitives.drag_grips import drag_covers, dragged, longest_drag, towards_robot
from planner.primitives.g_drag import GDrag
from planner.primitives.obstacle import Attempt, Situation, situation
from planner.primitives.state import State

_START = (0.0, 0.0)

_Place = tuple[int, int]

_AS_ONE = np.array([1 << 32, 1])
"""What makes one number of a place to the grid."""


class Places:
    """Answers whether situations can be brought about, and remembers."""

    def __init__(self, context: Context, reached: Collection[Situation]) -> None:
        """`reached`: the situations that the search came to."""
        self._context = context
        self._everywhere = (1 << context.back_offs) - 1
        self._drags = GDrag(context)
        counts = np.arange(1, longest_drag(context) + 1)[:, None]
        self._shifts = tuple(
            np.round(counts * np.array(dragged(context, _START, station, 1)) / LENGTH_M).astype(np.int64)
            for station in range(len(context.scene.stations))
        )
        self._origins_at: dict[int, dict[_Place, Point2]] = {}
        self._able: dict[tuple[int, int | None], NDArray[np.int64]] = {}
        self._led_to: dict[tuple[int, int, _Place, int], tuple[State, ...]] = {}
        self._taken: dict[tuple[int, int], frozenset[tuple[_Place, ...]]] = {}
        self._reached: dict[tuple[object, ...], dict[_Place, int]] = {}
        for done, x, y, held, is_dragged, back_off in reached:
            at = self._reached.setdefault((done, held, is_dragged), {})
            at[(x, y)] = at.get((x, y), 0) | (1 << back_off if held else self._everywhere)

    def worth_trying(self, attempt: Attempt) -> NDArray[np.int64]:
        """Which of an attempt's places may have `stands`, by their indices; a quick first look."""
        state = attempt.state
        able = [_as_one(np.array(list(self._reached_in(state)), dtype=np.int64))]
        if not state.held:
            able.append(self._led_to_by_any(state.done, None))
        elif self._is_taken(state):
            able.append(self._led_to_by_any(state.done, state.station))
        keys = np.round(attempt.places / LENGTH_M).astype(np.int64)
        return np.flatnonzero(np.isin(_as_one(keys), np.concatenate(able)))

    def stands(self, state: State) -> int:
        """The back-offs at which the base may be when a state's cloth lies and is held as it is, as a bit mask.

        0 where it cannot be brought about. With free hands the base may be anywhere.
        """
        reached = self._reached_in(state).get(_key(state.offset), 0)
        if state.held:
            return reached | self._left_by_drags(state.station, state)
        if reached or _key(state.offset) == _key(_START):
            return self._everywhere
        stations = range(len(self._context.scene.stations))
        return self._everywhere if any(self._left_by_drags(station, state) for station in stations) else 0

    def _reached_in(self, state: State) -> dict[_Place, int]:
        """Where the search came to with the folds done that are done in a state, and the same held."""
        done, _, _, held, is_dragged, _ = situation(state)
        return self._reached.get((done, held, is_dragged), {})

    def _origins(self, done: int) -> dict[_Place, Point2]:
        """Where the cloth may lie free before a drag, on the grid and in m, the start first."""
        if done not in self._origins_at:
            free = [_key(_START), *self._reached.get((done, (), False), {})]
            self._origins_at[done] = {(x, y): (x * LENGTH_M, y * LENGTH_M) for x, y in free}
        return self._origins_at[done]

    def _led_to_by_any(self, done: int, station: int | None) -> NDArray[np.int64]:
        """Where the cloth may lie free, or after one drag from a station (None: from any), each place as one number."""
        key = (done, station)
        if key not in self._able:
            shifts = np.vstack(self._shifts if station is None else self._shifts[station])
            origins = np.array(list(self._origins(done)), dtype=np.int64)
            led_to = (origins[:, None] + shifts[None]).reshape(-1, 2)
            self._able[key] = np.unique(_as_one(np.vstack([led_to, origins[:1]]) if station is None else led_to))
        return self._able[key]

    def _is_taken(self, state: State) -> bool:
        """Whether a drag from the start, by a robot at a state's station, takes the grips that are held in it."""
        key = (state.done, state.station)
        if key not in self._taken:
            towards = towards_robot(self._context, state.station)
            covers = drag_covers(self._context, state.done, _START, towards).covers
            self._taken[key] = frozenset(tuple(sorted(_key(grip) for grip in cover)) for cover in covers)
        return tuple(sorted(_key(held.point) for held in state.held)) in self._taken[key]

    def _left_by_drags(self, station: int, state: State) -> int:
        """The back-offs at which drags from a station leave the base that lead to a state's situation."""
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
        ends = {after.back_off for after in self._led_to[key] if tuple(h.key for h in after.held) == held}
        return sum(1 << end for end in ends)


def _key(place: Point2) -> _Place:
    """A place to the grid: dragging to and fro changes the last digits."""
    return (grid_key(place[0]), grid_key(place[1]))


def _as_one(places: NDArray[np.int64]) -> NDArray[np.int64]:
    """Places on the grid, shape (n, 2), as one number each."""
    return np.asarray(places.reshape(-1, 2) @ _AS_ONE)
