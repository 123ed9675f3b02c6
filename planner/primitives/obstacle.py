"""Why a fold was not possible: collected while searching, turned into reasons when there is no plan."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray, Point2
from planner.geometry.tolerance import grid_key


class Code(StrEnum):
    """The constraint that stopped a fold."""

    TOO_MANY_GRIPS = "too_many_grips"
    OUT_OF_REACH = "out_of_reach"
    NOT_A_G_STATE = "not_a_g_state"
    SLIPS = "slips"
    COLLISION = "collision"
    GRIPS_TOO_CLOSE = "grips_too_close"
    RED_NEEDS_HOLD = "red_needs_hold"
    LINE_OFF_TABLE = "line_off_table"
    WAITS_FOR_FOLD = "waits_for_fold"


@dataclass(frozen=True, eq=False, slots=True)
class Attempt:
    """A way to fold that the arms could not follow.

    Attributes:
        station: index of the station.
        offset: how far drags had carried the article (m).
        arms: the arm of each grip.
        tools: each grip's tool path in the table frame, shape (grips, n, 3), m.
        approaches: for each grip the approaches that were allowed.
    """

    station: int
    offset: Point2
    arms: tuple[int, ...]
    tools: FloatArray
    approaches: tuple[NDArray[np.int64], ...]


@dataclass(frozen=True, eq=False, slots=True)
class Obstacle:
    """One thing that stood in the way of one fold.

    Attributes:
        fold: the fold's index; None when it is about no fold.
        code: which constraint.
        message: a sentence with the numbers; empty for what is out of reach, which is diagnosed when asked for.
        severity: how far from possible it was, 0 just missed; only for comparing obstacles of one fold and code.
        attempt: what was tried, for what is out of reach.
    """

    fold: int | None
    code: Code
    message: str
    severity: float
    attempt: Attempt | None = None


@dataclass(slots=True)
class Obstacles:
    """For each fold and code the obstacle that came nearest to being passed, the first of equals."""

    nearest: dict[tuple[int | None, Code], Obstacle] = field(default_factory=dict)

    def note(self, obstacle: Obstacle) -> None:
        """Keep an obstacle if it is the mildest of its fold and code so far."""
        if self.is_mildest(obstacle.fold, obstacle.code, obstacle.severity):
            self.nearest[(obstacle.fold, obstacle.code)] = obstacle

    def is_mildest(self, fold: int | None, code: Code, severity: float) -> bool:
        """Whether an obstacle of this severity would be the mildest of its fold and code so far."""
        known = self.nearest.get((fold, code))
        return known is None or grid_key(severity) < grid_key(known.severity)

    def taken_away(self, fold: int) -> tuple[Obstacle, ...]:
        """What stood in one fold's way, forgotten here."""
        mine = self.of(fold)
        for obstacle in mine:
            del self.nearest[(fold, obstacle.code)]
        return mine

    def put_back(self, obstacles: tuple[Obstacle, ...]) -> None:
        """Note obstacles again."""
        for obstacle in obstacles:
            self.note(obstacle)

    def of(self, fold: int | None) -> tuple[Obstacle, ...]:
        """What stood in one fold's way, in the order in which it was met."""
        return tuple(o for o in self.nearest.values() if o.fold == fold)
