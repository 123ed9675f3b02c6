"""Ways to remove a cause: what changes, by how much, and the reason to tell once the change has been tried."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from planner.explain.relaxed import Relaxed
from planner.geometry.pose import Point3
from planner.geometry.tolerance import LENGTH_M
from planner.planning.trial import Trial
from planner.task.reason import Reason


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """A way to remove a cause.

    Attributes:
        kind: what is changed; two ways of one kind are not combined.
        amounts: by how much, tried in turn, the last the most permissive; empty where the change has no degree.
        applied: applies the change by an amount to a problem.
        told: makes the reason to tell once the amount was tried.
        needed: the amount that the path found really needs, where that can be told.
        exact: the resolution of the least amount: with an amount smaller by this the fold cannot be done.
        is_dream: whether no robot can be changed like this; the way still shows what stands in the way.
    """

    kind: str
    amounts: tuple[float, ...]
    applied: Callable[[Relaxed, float], Relaxed]
    told: Callable[[Reason, float], Reason] = lambda reason, _: reason
    needed: Callable[[Trial], float] | None = None
    exact: float = 0.001
    is_dream: bool = False

    @property
    def most(self) -> float:
        """The largest amount; 0 where there are none."""
        return max(self.amounts, default=0.0)


COLLISIONS_IGNORED = Way("collision", (), lambda relaxed, _: relaxed.with_collisions_ignored())
"""Shows that nothing but collisions of the arms stands in the way."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A possible cause, and ways to remove it, those first that a person can carry out."""

    reason: Reason
    ways: tuple[Way, ...]


def moved(kind: str, towards: Point3, by_m: float, further_m: tuple[float, ...] = ()) -> Way:
    """Return the way of moving the cloth in a direction of the table frame, by `by_m` or by some lengths more (m)."""

    def applied(relaxed: Relaxed, amount: float) -> Relaxed:
        x, y, _ = (amount * part for part in towards)
        return relaxed.with_placement(relaxed.context.placement.moved(x, y))

    amounts = tuple(by_m + 2 * LENGTH_M + more for more in (0.0, *further_m))
    return Way(kind, amounts, applied, lambda reason, by: replace(reason, shift_m=by, shift_towards=towards))
