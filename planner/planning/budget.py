"""What a search may spend: work, which is counted, and time, which is clocked.

How much can be done in a second depends on the machine and on what else it does. So that the same request has the same
answer everywhere, a search mostly ends by the work it has done. What is done is counted, and weighed by what it took on
the machine on which that was measured: the unit is a second of that machine. The clock is only the upper limit.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from planner.planning.problem import Problem

_LOOK_S, _QUERY_S, _GLANCE_S, _TRY_S = 3.5e-4, 4e-7, 1e-3, 1.6e-2
"""What it takes to look at a state or at what may leave it; to ask the exact kernel about a tool point; to look at the
ends of a run; to lead the arms through one (s). Fitted to the CPU time of 25 requests on two busy cores of 2026: the
articles here and there on the table, and cloth with two dozen loose folds."""

_FEW_FOLDS = 4
"""Cloth with more folds than this takes longer to look at, in proportion."""


@dataclass(slots=True)
class Budget:
    """What is left of the work and the time for a search.

    Attributes:
        work_limit_s: the work, in seconds of the machine on which it was measured.
        deadline_s: when the time is up, by `time.perf_counter` (s).
        should_stop: asked as well; true ends the search.
        looks: how many states, and promises of what leaves one, have been looked at.
        beside_s: the work that was done with budgets of its own (s).
    """

    work_limit_s: float
    deadline_s: float
    should_stop: Callable[[], bool]
    looks: int = 0
    beside_s: float = 0.0
    _problems: list[Problem] = field(default_factory=list)

    @staticmethod
    def of(work_limit_s: float | None, time_limit_s: float, should_stop: Callable[[], bool] | None = None) -> "Budget":
        """Return a budget whose time begins to run; without a limit of its own it has as much work as time."""
        work_s = time_limit_s if work_limit_s is None else work_limit_s
        return Budget(work_s, time.perf_counter() + time_limit_s, should_stop or (lambda: False))

    def part(self, work_s: float) -> "Budget":
        """Return a budget for some of the work, to be done while there is time for the whole."""
        return Budget(work_s, self.deadline_s, self.should_stop)

    def watch(self, problem: Problem) -> Problem:
        """Count from now on what is asked of a problem's reach, and the joint paths made for it; return it."""
        self._problems.append(problem)
        return problem

    @property
    def spent_s(self) -> float:
        """The work done so far (s)."""
        makers = [problem.maker for problem in self._problems]
        queries = sum(problem.context.reach.queries for problem in self._problems)
        glances, tries = sum(maker.glances for maker in makers), sum(maker.tries for maker in makers)
        folds = max((len(problem.context.sequence.folds) for problem in self._problems), default=0)
        return (
            self.looks * _LOOK_S * max(1.0, folds / _FEW_FOLDS)
            + queries * _QUERY_S
            + glances * _GLANCE_S
            + tries * _TRY_S
            + self.beside_s
        )

    @property
    def ways(self) -> int:
        """How many ways to go on were looked at, in the search and with the arms."""
        return self.looks + sum(problem.maker.glances for problem in self._problems)

    @property
    def is_over(self) -> bool:
        """Whether there is nothing left, or somebody wants no more."""
        if math.isfinite(self.work_limit_s) and self.spent_s > self.work_limit_s:
            return True
        return self.is_late

    @property
    def is_late(self) -> bool:
        """Whether the time is up, whatever work is left, or somebody wants no more."""
        return time.perf_counter() > self.deadline_s or self.should_stop()
