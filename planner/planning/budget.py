"""Limit what a search may spend: work, which is counted, and time, which is measured.

How much a machine does in a second depends on the machine and its load. So that the same request has the same answer
everywhere, a search usually ends by the work it has done. The work is counted and weighted by its measured duration;
its unit is a second of the machine on which that was measured. Time is only the upper limit (`Deadline`).

A budget is handed down to all that takes long, and polled there: `is_over` is the one way to ask whether to go on.
"""

import math
from dataclasses import dataclass, field

from planner.deadline import Deadline, ShouldStop
from planner.planning.problem import Problem

# Fitted to the CPU time of 25 requests on two busy cores of 2026: the garments here and there on the table, and cloth
# with two dozen loose folds.
_LOOK_S, _QUERY_S, _GLANCE_S, _TRY_S, _TRANSIT_S = 3.5e-4, 4e-7, 1e-3, 1.6e-2, 2e-2
"""Work for a look at a state or at what may leave it, for a query of the exact kernel about a tool point, for a look at
the ends of a transfer, for leading the arms through one, and for a way of empty hands to the next (s)."""

_FEW_FOLDS = 4
"""Folds up to which a look costs `_LOOK_S`; with more folds it costs more, in proportion."""


class OutOfTimeError(Exception):
    """No time was left to validate steps, or no more work was allowed."""


@dataclass(slots=True)
class Budget:
    """The work and the time that a search has left.

    Attributes:
        work_limit_s: the work allowed, in seconds of the machine on which it was measured.
        deadline: when the time is up, or nobody wants the answer any more.
        looks: the number of states, and of deferred successors, looked at.
        beside_s: the work done under separate budgets (s).
        is_strict: whether a search that has a plan does nothing beside it once the budget is over.
    """

    work_limit_s: float
    deadline: Deadline
    looks: int = 0
    beside_s: float = 0.0
    is_strict: bool = False
    _problems: list[Problem] = field(default_factory=list)
    _folds: int = 0

    @staticmethod
    def of(work_limit_s: float | None, time_limit_s: float, should_stop: ShouldStop | None = None) -> "Budget":
        """Return a budget whose time starts now; without a work limit it allows as much work as time."""
        work_s = time_limit_s if work_limit_s is None else work_limit_s
        return Budget(work_s, Deadline(time_limit_s, should_stop))

    @staticmethod
    def endless(should_stop: ShouldStop | None = None) -> "Budget":
        """Return a budget that is over only when the search is stopped."""
        return Budget.of(math.inf, math.inf, should_stop)

    def part(self, work_s: float) -> "Budget":
        """Return a budget for a part of the work, with the deadline of the whole."""
        return Budget(work_s, self.deadline)

    def widen(self, whole: "Budget") -> None:
        """Allow as much as another budget does."""
        self.work_limit_s = whole.work_limit_s
        self.deadline.put_off(whole.deadline)

    def narrow(self, work_s: float) -> None:
        """Allow no more than that work, and nothing further once it is done."""
        self.work_limit_s, self.is_strict = min(self.work_limit_s, work_s), math.isfinite(work_s)

    def watch(self, problem: Problem) -> Problem:
        """Start to count the reach queries and joint paths of a problem; return the problem."""
        self._problems.append(problem)
        self._folds = max(self._folds, len(problem.context.sequence.folds))
        return problem

    @property
    def spent_s(self) -> float:
        """The work done so far (s)."""
        # Asked for at each look: plain loops take a third of what generators took.
        queries = glances = path_requests = transits = 0
        for problem in self._problems:
            queries += problem.context.reach.memory.queries
            glances += problem.maker.glances
            path_requests += problem.maker.path_requests
            transits += problem.maker.transits_planned
        return (
            self.looks * _LOOK_S * max(1.0, self._folds / _FEW_FOLDS)
            + queries * _QUERY_S
            + glances * _GLANCE_S
            + path_requests * _TRY_S
            + transits * _TRANSIT_S
            + self.beside_s
        )

    @property
    def ways(self) -> int:
        """The number of ways to continue that were looked at, in the search and with the arms."""
        return self.looks + sum(problem.maker.glances for problem in self._problems)

    @property
    def is_over(self) -> bool:
        """Whether the work or the time is used up, or the search was stopped."""
        if math.isfinite(self.work_limit_s) and self.spent_s > self.work_limit_s:
            return True
        return self.deadline.is_over

    @property
    def left_s(self) -> float:
        """The time that is left, whatever work is (s); negative once it is up."""
        return self.deadline.left_s
