"""Why a fold was not possible: collected while searching, turned into reasons when there is no plan.

What stops a fold is noted with the state in which it did. What the arms could not follow is only noted as an attempt,
which costs next to nothing: how far out of reach it was is worked out when somebody asks.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.cloth.grips import Cover
from planner.folds.fold_path import FoldPath
from planner.geometry.pose import FloatArray, Point2, Point3
from planner.geometry.tolerance import grid_key
from planner.message import Message
from planner.primitives.state import State
from planner.task.reason import Code

Situation: TypeAlias = tuple[int, int, int, tuple[tuple[int, int, int], ...], bool, int]
"""What of a state matters to whether a fold is possible: the folds done (a bit mask), where the article lies, what is
held and whether from a drag; and how far the base has backed off, if anything is held, for else it may drive."""


def situation(state: State) -> Situation:
    """What of a state matters to whether a fold is possible, places to the grid."""
    done, x, y, _, back_off, held, dragged = state.key
    return (done, x, y, held, dragged > 0, back_off if held else -1)


@dataclass(frozen=True, eq=False, slots=True)
class BlockingContact:
    """What an arm cannot help touching, at the moment of a motion at which that is worst.

    Attributes:
        arm: the arm's name.
        point: where its tool is then, table frame (m).
        cause: what it touches: ``table``, ``own_body`` or ``arms``.
        parts: what people call the two that touch, the arm's own first: ``left forearm``, ``table top``.
        depth_m: how far they are into each other at least (m).
    """

    arm: str
    point: Point3
    cause: str
    parts: tuple[str, str]
    depth_m: float


@dataclass(frozen=True, eq=False, slots=True)
class Obstacle:
    """One thing that stood in the way of one fold.

    Attributes:
        fold: the fold's index; None when it is about no fold.
        code: which constraint.
        says: a sentence with the numbers; None where it is worked out when asked for.
        severity: how far from possible it was (m, or of the friction coefficient), 0 just missed; infinite where that
            is not known.
        state: the state in which it did, of a drag that in which it begins; None where that does not matter.
        point: where, article frame (m), of a drag what the hand holds; None where it is no one place.
        contact: of a collision what touches what, where that is known.
        dragged_to: of a collision in a drag that the fold would need the offset to which that leads (m).
    """

    fold: int | None
    code: Code
    says: Message | None
    severity: float
    state: State | None = None
    point: Point2 | None = None
    contact: BlockingContact | None = None
    dragged_to: Point2 | None = None

    def is_milder_than(self, other: "Obstacle") -> bool:
        """Whether it was nearer to possible, by more than rounding."""
        if math.isinf(other.severity):
            return not math.isinf(self.severity)
        return not math.isinf(self.severity) and grid_key(self.severity) < grid_key(other.severity)


@dataclass(frozen=True, eq=False, slots=True)
class Attempt:
    """A way to fold that the arms could not follow, at one place of the article or at any of several.

    Attributes:
        fold: the fold's index.
        state: the state in which it was tried, at one of the places.
        cover: what is held, article frame (m).
        arms: the arm of each grip.
        path: the fold's path in that state.
        points: the grips in the table frame's unrolled plane in that state, shape (grips, 2), m.
        approaches: for each grip the approaches that were allowed.
        places: offsets of the article at which it was tried, shape (n, 2), m.
    """

    fold: int
    state: State
    cover: Cover
    arms: tuple[int, ...]
    path: FoldPath
    points: FloatArray
    approaches: tuple[NDArray[np.int64], ...]
    places: FloatArray

    def at(self, index: int) -> State:
        """The state with the article at one of the places."""
        x, y = (float(c) for c in self.places[index])
        state = self.state
        return State(state.done, (x, y), state.station, state.back_off, state.held, state.dragged)

    @property
    def kind(self) -> tuple[object, ...]:
        """What it has in common with attempts that differ in the article's place only."""
        state = self.state
        grips = tuple((grid_key(x), grid_key(y)) for x, y in self.cover)
        return (self.fold, state.done, state.station, bool(state.held), state.is_dragged, grips, self.arms)


@dataclass(slots=True)
class Obstacles:
    """What stood in the folds' ways: for each fold, code and situation the mildest obstacle, and all attempts.

    What stood in the way of a drag that a fold would need is kept beside what stood in the fold's own.
    """

    _met: dict[tuple[object, ...], Obstacle] = field(default_factory=dict)
    _tried: dict[tuple[object, ...], list[Attempt]] = field(default_factory=dict)

    def note(self, obstacle: Obstacle) -> None:
        """Keep an obstacle if it is the mildest of its fold, code and situation so far."""
        where = None if obstacle.state is None else situation(obstacle.state)
        key = (obstacle.fold, obstacle.code, where, obstacle.dragged_to is None)
        known = self._met.get(key)
        if known is None or obstacle.is_milder_than(known):
            self._met[key] = obstacle

    def note_attempt(self, attempt: Attempt) -> None:
        """Keep an attempt."""
        self._tried.setdefault(attempt.kind, []).append(attempt)

    def of(self, fold: int | None) -> tuple[Obstacle, ...]:
        """What stood in one fold's way, its attempts aside, in the order in which it was met."""
        return tuple(o for o in self._met.values() if o.fold == fold)

    def attempts(self, fold: int) -> Iterator[Attempt]:
        """The attempts at one fold, those that differ in the article's place only as one."""
        for alike in self._tried.values():
            first = alike[0]
            if first.fold == fold:
                of_hands = zip(*(attempt.approaches for attempt in alike), strict=True)
                approaches = tuple(np.unique(np.concatenate(of_hand)) for of_hand in of_hands)
                yield replace(first, approaches=approaches, places=np.vstack([a.places for a in alike]))

    def dones(self, fold: int) -> set[int]:
        """The sets of folds done, as bit masks, after which one fold was stopped or tried in vain."""
        stopped = {o.state.done for o in self._met.values() if o.fold == fold and o.state is not None}
        return stopped | {alike[0].state.done for alike in self._tried.values() if alike[0].fold == fold}

    def codes(self, fold: int) -> tuple[Code, ...]:
        """The constraints that stopped one fold."""
        found = dict.fromkeys(o.code for o in self.of(fold))
        if any(alike[0].fold == fold for alike in self._tried.values()):
            found[Code.OUT_OF_REACH] = None
        return tuple(found)

    def taken_away(self, fold: int) -> "Obstacles":
        """What stood in one fold's way, forgotten here."""
        mine = Obstacles(
            {key: o for key, o in self._met.items() if o.fold == fold},
            {key: alike for key, alike in self._tried.items() if alike[0].fold == fold},
        )
        for key in mine._met:
            del self._met[key]
        for kind in mine._tried:
            del self._tried[kind]
        return mine

    def put_back(self, others: "Obstacles") -> None:
        """Note again what others know."""
        for obstacle in others._met.values():
            self.note(obstacle)
        for alike in others._tried.values():
            for attempt in alike:
                self.note_attempt(attempt)
