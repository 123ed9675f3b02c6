"""The point of an attempt at a fold that is furthest out of reach."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from planner.geometry.shortfall import Shortfall
from planner.primitives.fold_trial import FoldTrial
from planner.primitives.state import State


class Demand(StrEnum):
    """The requirements on a point that is out of reach."""

    ALONE = "alone"
    ONE_ORIENTATION = "one orientation"
    DRIVING = "driving"
    WITH_THE_OTHER_HAND = "with the other hand"


@dataclass(frozen=True, eq=False, slots=True)
class Miss:
    """The point of an attempt that is furthest out of reach, seen from where it is least so.

    Attributes:
        state: the state in which the attempt was made.
        trial: the attempt.
        stands: the standoffs at which the base may be when it begins, as a bit mask.
        grip: the index of the grip.
        waypoint: the index of the waypoint in the trial.
        standoff: the standoff from which the point is least out of reach.
        shortfall: by how much, and why.
        demand: what the point must satisfy.
    """

    state: State
    trial: FoldTrial
    stands: int
    grip: int
    waypoint: int
    standoff: int
    shortfall: Shortfall
    demand: Demand

    @property
    def short_by_m(self) -> float:
        """The distance by which the point would have to be displaced (m)."""
        return self.shortfall.short_by_m


def worst_miss(misses: Iterable[Miss | None]) -> Miss | None:
    """Return the miss that lacks most, the first of equals; None if there is none."""
    return max((m for m in misses if m is not None), key=lambda m: m.short_by_m, default=None)


def least_miss(misses: Iterable[Miss | None]) -> Miss | None:
    """Return the miss that lacks least, the first of equals; None if there is none."""
    return min((m for m in misses if m is not None), key=lambda m: m.short_by_m, default=None)
