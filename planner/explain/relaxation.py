"""Relaxations: changes that remove a cause, by how much, and the reason to report once the change has been tried."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from planner.explain.relaxed_problem import RelaxedProblem
from planner.geometry.pose import Point3
from planner.geometry.tolerance import LENGTH_M
from planner.planning.trial import Trial
from planner.task.reason import Reason


@dataclass(frozen=True, slots=True, eq=False)
class Relaxation:
    """A change that removes a cause.

    Attributes:
        kind: what is changed; two relaxations of one kind are not combined.
        amounts: by how much, tried in turn, the last the most permissive; empty where the change has no degree.
        applied: applies the change by an amount to a problem.
        told: makes the reason to report once the amount was tried.
        needed: the amount that the path found really needs, where that can be told.
        exact: the resolution of the least amount: with an amount smaller by this the fold cannot be done.
        is_hypothetical: whether no robot can be changed like this; the relaxation still shows what stands in the way.
    """

    kind: str
    amounts: tuple[float, ...]
    applied: Callable[[RelaxedProblem, float], RelaxedProblem]
    told: Callable[[Reason, float], Reason] = lambda reason, _: reason
    needed: Callable[[Trial], float] | None = None
    exact: float = 0.001
    is_hypothetical: bool = False

    @property
    def most(self) -> float:
        """The largest amount; 0 where there are none."""
        return max(self.amounts, default=0.0)


COLLISIONS_IGNORED = Relaxation("collision", (), lambda relaxed, _: relaxed.with_collisions_ignored())
"""Shows that nothing but collisions of the arms stands in the way."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A possible cause, and the relaxations that may remove it, first those that a person can carry out."""

    reason: Reason
    relaxations: tuple[Relaxation, ...]


def moved(kind: str, towards: Point3, by_m: float, further_m: tuple[float, ...] = ()) -> Relaxation:
    """Return a move of the cloth in a direction of the table frame, by `by_m` or by some lengths more (m)."""

    def applied(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        x, y, _ = (amount * part for part in towards)
        return relaxed.with_placement(relaxed.context.placement.moved(x, y))

    amounts = tuple(by_m + 2 * LENGTH_M + more for more in (0.0, *further_m))
    return Relaxation(kind, amounts, applied, lambda reason, by: replace(reason, shift_m=by, shift_towards=towards))
