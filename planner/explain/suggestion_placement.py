"""Suggest another place on the table, the nearest first, also turned, and finally the best place seen."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from planner.explain.suggestion_grid import Room, turned_in_place
from planner.explain.suggestion_trial import Narrowing, Proof, Search, Trial, narrowed
from planner.geometry.pose import Pose2
from planner.message import Message
from planner.task.task import Task
from planner.words.catalogue import worded

STEP_M = 0.1
"""Step of the grid of placements (m); every other place is tried first."""

NARROWED_TO_M = 0.05
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
    for place in _places(task):
        trial = _trial(task, place)
        plan = yield trial
        if plan is None:
            break
        proof = Proof.of(trial, plan)
        if proof is None:
            continue
        if to_beat is None:
            nearest = yield from _nearer(task, place, proof)
            to_beat = nearest.cost_s
        best = proof if best is None or proof.cost_s < best.cost_s else best
    if best is not None and to_beat is not None and best.is_worth_more_than(to_beat):
        yield best.suggestion


def _nearer(task: Task, place: _Place, proof: Proof) -> Narrowing:
    """Look for the nearest place in the same direction that works."""
    far_m = place.distance_m
    room = _room(task, place.quarters)

    def at(distance_m: float) -> Trial | None:
        share = distance_m / far_m
        nearer = replace(place, dx_m=share * place.dx_m, dy_m=share * place.dy_m)
        return _trial(task, nearer) if room.holds(nearer.dx_m, nearer.dy_m) else None

    start_m = far_m - NARROWED_TO_M * round(far_m / NARROWED_TO_M)
    return narrowed(at, start_m, far_m, proof, NARROWED_TO_M)


def _trial(task: Task, place: _Place) -> Trial:
    pose = _turned(task, place.quarters).moved(place.dx_m, place.dy_m)
    return Trial("placement", place.says, {"placement": pose.to_dict()}, place.size, task.at(pose))


def _places(task: Task) -> list[_Place]:
    """Return all places except where the garment lies: the coarse grid first, nearest first."""
    found = [(is_coarse, place) for quarters in range(4) for is_coarse, place in _turned_places(task, quarters)]
    found.sort(key=lambda one: (not one[0], one[1].size, one[1].dx_m, one[1].dy_m))
    return [place for _, place in found if place.size > NARROWED_TO_M / 2]


def _turned_places(task: Task, quarters: int) -> Iterator[tuple[bool, _Place]]:
    room = _room(task, quarters)
    if not room.is_none:
        yield True, _Place(quarters, *room.nearest)
    for i, j in room.moves(STEP_M):
        if (i, j) != (0, 0):
            yield i % 2 == 0 and j % 2 == 0, _Place(quarters, i * STEP_M, j * STEP_M)


def _room(task: Task, quarters: int) -> Room:
    return Room.of(task.garment, _turned(task, quarters), task.scene.table)


def _turned(task: Task, quarters: int) -> Pose2:
    return turned_in_place(task.garment, task.start.placement, quarters)
