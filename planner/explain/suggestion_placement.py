"""Suggest another place on the table, the nearest first, also turned, and finally the best place seen.

Places of a grid on which the garment lies wholly are tried. The move to one that gives a plan is then made as short as
it can be with a plan as good; on the way the garment may hang over an edge, but no further than where it lies now.

A base that does not move has no other freedom than the place of the cloth. There more places are tried, and drags by
the arms, which are much more work, only where folds alone give no plan at any of them.
"""

import math
from collections.abc import Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial

from planner.explain.change import SpentError
from planner.explain.room import Room, turned_in_place
from planner.explain.suggestion import AS_QUICK_S, Search, Suggestion, SuggestionTrial, proven, smallest
from planner.geometry.pose import Pose2
from planner.message import Message
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan
from planner.task.task import Task
from planner.words.catalogue import worded

STEP_M = 0.1
"""Step of the grid of placements (m); every other place is tried first."""

FINE_STEP_M = 0.05
"""The same for a base that does not move, where the grid has no place that gives a plan (m)."""

NARROWED_TO_M = 0.01
"""The resolution of the nearest place (m)."""

TURN_AS_M = 0.3
"""Length of a move that counts as much as turning the garment (m)."""


@dataclass(frozen=True, slots=True)
class _Place:
    """A place for the garment: turned by quarters, then moved (m)."""

    quarters: int
    dx_m: float
    dy_m: float

    @property
    def distance_m(self) -> float:
        return math.hypot(self.dx_m, self.dy_m)

    @property
    def size(self) -> float:
        return self.distance_m + (TURN_AS_M if self.quarters else 0.0)

    def without(self, part: "_Place", share: float) -> "_Place":
        """Return the place with a share of a part of its move left out."""
        return replace(self, dx_m=self.dx_m - share * part.dx_m, dy_m=self.dy_m - share * part.dy_m)

    @property
    def says(self) -> Message:
        return worded("place", {"quarters": self.quarters, "by": [self.dx_m, self.dy_m]})


def placements(task: Task, known_cost_s: float | None) -> Search:
    """Look for a nearby placement that gives a plan, and for the best one.

    Args:
        task: the task.
        known_cost_s: the cost of its plan (s), which a suggestion must then beat; None if it has no plan.
    """
    to_beat, best = known_cost_s, None
    with suppress(SpentError):
        for place, is_last_resort, by_folds_alone in _tried(task):
            if is_last_resort and to_beat is not None:
                break
            proof = yield from proven(_trial(task, place, by_folds_alone=by_folds_alone))
            if proof is None:
                continue
            if to_beat is None:
                nearest = yield from _nearer(task, place, proof, math.inf)
                yield nearest
                to_beat = nearest.cost_s
            best = (place, proof) if best is None or proof.cost_s < best[1].cost_s - AS_QUICK_S else best
    if best is not None and to_beat is not None and best[1].is_worth_more_than(to_beat):
        nearest = yield from _nearer(task, *best, best[1].cost_s + AS_QUICK_S)
        yield nearest


def _tried(task: Task) -> Iterator[tuple[_Place, bool, bool]]:
    """Yield the places to try: each with whether it is tried only without any plan so far, and by folds alone."""
    if not load_robot(task.robot).card.is_fixed:
        yield from ((place, False, False) for place in _places(task, STEP_M))
        return
    places, more = _places(task, STEP_M), _places(task, FINE_STEP_M)
    yield from ((place, False, True) for place in places)
    yield from ((place, True, True) for place in more if place not in places)
    yield from ((place, True, False) for place in more)


def _nearer(
    task: Task, place: _Place, proof: Suggestion, most_s: float
) -> Generator[SuggestionTrial | Suggestion, Plan | None, Suggestion]:
    """Look for the shortest move in the same direction with a plan that costs at most `most_s` (s), then along x and y.

    A move that does not turn the garment is at least one step long.
    """
    for along_x, along_y in ((True, True), (True, False), (False, True)):
        part = _Place(0, along_x * place.dx_m, along_y * place.dy_m)
        is_whole = part.distance_m == place.distance_m
        if part.distance_m < NARROWED_TO_M or (is_whole and along_x != along_y):
            continue
        fails_at = part.distance_m - NARROWED_TO_M * round(part.distance_m / NARROWED_TO_M)
        if place.quarters or not is_whole:
            fails_at -= NARROWED_TO_M  # not to move it in this direction at all may do
        at = partial(_shortened, task, place, part, proof.trial.by_folds_alone)
        amount_m, proof = yield from smallest(at, fails_at, part.distance_m, proof, NARROWED_TO_M, most_s)
        place = place.without(part, 1.0 - amount_m / part.distance_m)
    return proof


def _shortened(
    task: Task, place: _Place, part: _Place, by_folds_alone: bool, distance_m: float
) -> SuggestionTrial | None:
    """Return the trial of a shortened move (m); None if more cloth would then hang over an edge."""
    nearer = place.without(part, 1.0 - distance_m / part.distance_m)
    if not _room(task, nearer.quarters).hangs_no_more(nearer.dx_m, nearer.dy_m):
        return None
    return _trial(task, nearer, by_folds_alone=by_folds_alone)


def _trial(task: Task, place: _Place, *, by_folds_alone: bool) -> SuggestionTrial:
    pose = _turned(task, place.quarters).moved(place.dx_m, place.dy_m)
    return SuggestionTrial("placement", place.says, place.size, task, task.at(pose), by_folds_alone)


def _places(task: Task, step_m: float) -> list[_Place]:
    """Return all places of a grid except where the garment lies: every other one first, nearest first."""
    found = [(is_coarse, place) for quarters in range(4) for is_coarse, place in _turned_places(task, quarters, step_m)]
    found.sort(key=lambda one: (not one[0], one[1].size, one[1].dx_m, one[1].dy_m))
    return [place for _, place in found if place.size > NARROWED_TO_M / 2]


def _turned_places(task: Task, quarters: int, step_m: float) -> Iterator[tuple[bool, _Place]]:
    room = _room(task, quarters)
    if not room.is_none:
        yield True, _Place(quarters, *room.nearest)
    for i, j in room.moves(step_m):
        if (i, j) != (0, 0):
            yield i % 2 == 0 and j % 2 == 0, _Place(quarters, i * step_m, j * step_m)


def _room(task: Task, quarters: int) -> Room:
    return Room.of(task.garment, _turned(task, quarters), task.scene.table)


def _turned(task: Task, quarters: int) -> Pose2:
    return turned_in_place(task.garment, task.start.placement, quarters)
