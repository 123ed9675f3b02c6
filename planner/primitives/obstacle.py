"""Record why a fold was not possible while searching, to be turned into reasons when there is no plan.

An obstacle is noted with the state in which it stopped a fold. A path that the arms could not follow is noted as an
attempt, which costs next to nothing: how far out of reach it was is computed when somebody asks.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.cloth.g_state import StabilityViolation
from planner.cloth.grips import Cover
from planner.folds.fold_path import FoldPath
from planner.geometry.pose import FloatArray, Point2, Point3
from planner.geometry.tolerance import grid_key
from planner.message import Message
from planner.primitives.state import State
from planner.task.reason import Code

Situation: TypeAlias = tuple[int, int, int, tuple[tuple[int, int, int], ...], bool, int]
"""The part of a state that decides whether a fold is possible.

The folds done (a bit mask), the garment's place, the grips held, whether they are held from a drag, and the standoff:
-1 if nothing is held, because the base may then drive.
"""


def situation(state: State) -> Situation:
    """Return the part of a state that decides whether a fold is possible, places on the grid."""
    done, x, y, _, standoff, held, dragged = state.key
    return (done, x, y, held, dragged > 0, standoff if held else -1)


@dataclass(frozen=True, eq=False, slots=True)
class BlockingContact:
    """A contact that an arm cannot avoid, at the moment of a motion at which it is deepest.

    Attributes:
        arm: the arm's name.
        point: the position of its tool at that moment, table frame (m).
        cause: what it touches: ``table``, ``own_body`` or ``arms``.
        parts: the everyday names of the two bodies in contact, the arm's own first: ``left forearm``, ``table top``.
        depth_m: how deep they penetrate each other at least (m).
    """

    arm: str
    point: Point3
    cause: str
    parts: tuple[str, str]
    depth_m: float


@dataclass(frozen=True, eq=False, slots=True)
class Obstacle:
    """A constraint that stopped one fold.

    Attributes:
        fold: the fold's index; None if the obstacle is not about a fold.
        code: the constraint.
        says: a sentence with the numbers; None where it is made on request.
        severity: how far from possible the fold was (m, or in units of the friction coefficient); 0: just missed;
            infinite: unknown.
        state: the state in which the fold was stopped; of a drag the state in which it begins; None where that does not
            matter.
        point: the place of the obstacle, garment frame (m); of a drag the point that the hand holds; None where there
            is no single place.
        contact: of a collision the contact, where that is known.
        dragged_to: of a collision in a drag that the fold would need, the offset to which the drag leads (m).
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
        """Return whether it was nearer to possible, by more than rounding."""
        if math.isinf(other.severity):
            return not math.isinf(self.severity)
        return not math.isinf(self.severity) and grid_key(self.severity) < grid_key(other.severity)


@dataclass(frozen=True, eq=False, slots=True)
class Attempt:
    """A way to fold that the arms could not follow, at one place of the garment or at any of several.

    Attributes:
        fold: the fold's index.
        state: the state in which it was tried, at one of the places.
        cover: the points held, garment frame (m).
        arms: the arm of each grip.
        path: the fold's path in that state.
        points: the grips in the table frame's unrolled plane in that state, shape (grips, 2), m.
        approaches: for each grip the approaches that were allowed.
        places: offsets of the garment at which it was tried, shape (n, 2), m.
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
        """Return the state with the garment at one of the places."""
        x, y = (float(c) for c in self.places[index])
        state = self.state
        return State(state.done, (x, y), state.station, state.standoff, state.held, state.dragged)

    @property
    def kind(self) -> tuple[object, ...]:
        """The key it shares with attempts that differ in the garment's place only."""
        state = self.state
        grips = tuple((grid_key(x), grid_key(y)) for x, y in self.cover)
        return (self.fold, state.done, state.station, bool(state.held), state.is_dragged, grips, self.arms)


@dataclass(slots=True)
class Obstacles:
    """The obstacles met: for each fold, code and situation the mildest one, and all attempts.

    Obstacles to a drag that a fold would need are kept beside the fold's own.

    Attributes:
        has_slipped: whether the cloth would have slipped somewhere; more friction would hold it.
    """

    _met: dict[tuple[object, ...], Obstacle] = field(default_factory=dict)
    _tried: dict[tuple[object, ...], list[Attempt]] = field(default_factory=dict)
    has_slipped: bool = False

    def note_violation(self, violation: StabilityViolation | None) -> None:
        """Note why the cloth would not stay at some placement; None where it would."""
        self.has_slipped = self.has_slipped or (violation is not None and violation.code == "slips")

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
        """Return the obstacles to one fold, without its attempts, in the order in which they were met."""
        return tuple(o for o in self._met.values() if o.fold == fold)

    def attempts(self, fold: int) -> Iterator[Attempt]:
        """Yield the attempts at one fold; those that differ in the garment's place only are merged into one."""
        for alike in self._tried.values():
            first = alike[0]
            if first.fold == fold:
                of_hands = zip(*(attempt.approaches for attempt in alike), strict=True)
                approaches = tuple(np.unique(np.concatenate(of_hand)) for of_hand in of_hands)
                yield replace(first, approaches=approaches, places=np.vstack([a.places for a in alike]))

    def dones(self, fold: int) -> set[int]:
        """Return the sets of folds done, as bit masks, after which one fold was stopped or tried in vain."""
        stopped = {o.state.done for o in self._met.values() if o.fold == fold and o.state is not None}
        return stopped | {alike[0].state.done for alike in self._tried.values() if alike[0].fold == fold}

    def codes(self, fold: int) -> tuple[Code, ...]:
        """Return the constraints that stopped one fold."""
        found = dict.fromkeys(o.code for o in self.of(fold))
        if any(alike[0].fold == fold for alike in self._tried.values()):
            found[Code.OUT_OF_REACH] = None
        return tuple(found)

    def taken_away(self, fold: int) -> "Obstacles":
        """Remove and return the obstacles to one fold."""
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
        """Note all obstacles and attempts of `others`."""
        for obstacle in others._met.values():
            self.note(obstacle)
        for alike in others._tried.values():
            for attempt in alike:
                self.note_attempt(attempt)
