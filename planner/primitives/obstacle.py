"""Why a primitive was not possible: collected while searching, turned into reasons when there is no plan."""

from dataclasses import dataclass, field
from enum import StrEnum


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


@dataclass(frozen=True, slots=True)
class Obstacle:
    """One thing that stood in the way of one fold.

    Attributes:
        fold: the fold's index; None when it is about no fold.
        code: which constraint.
        message: a sentence with the numbers.
        severity: how far from possible it was, 0 just missed; only for comparing obstacles of one fold.
    """

    fold: int | None
    code: Code
    message: str
    severity: float


@dataclass(slots=True)
class Obstacles:
    """For each fold the obstacles that came nearest to being passed, one of each code."""

    nearest: dict[tuple[int | None, Code], Obstacle] = field(default_factory=dict)

    def note(self, obstacle: Obstacle) -> None:
        """Keep an obstacle if it is the mildest of its fold and code so far."""
        key = (obstacle.fold, obstacle.code)
        if key not in self.nearest or obstacle.severity < self.nearest[key].severity:
            self.nearest[key] = obstacle

    def of(self, fold: int | None) -> tuple[Obstacle, ...]:
        """What stood in one fold's way, mildest first."""
        mine = [o for o in self.nearest.values() if o.fold == fold]
        return tuple(sorted(mine, key=lambda o: o.severity))
