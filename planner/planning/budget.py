"""Limit what a search may spend: work, which is counted, and time, which is measured.

How much a machine does in a second depends on the machine and its load. So that the same request has the same answer
everywhere, a search usually ends by the work it has done. The work is counted and weighted by its measured duration;
its unit is a second of the machine on which that was measured. Time is only the upper limit, and it is the processor
time of the process that searches: beside other programs a search takes longer, and finds the same. So that whoever
waits gets an answer all the same, the clock on the wall ends it too, much later (`WALL_FACTOR`).
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from planner.planning.problem import Problem
from planner.primitives.context import Patience
from planner.robots.reach_maps import building_time_s

# Fitted to the CPU time of 25 requests on two busy cores of 2026: the articles here and there on the table, and cloth
# with two dozen loose folds.
_LOOK_S, _QUERY_S, _GLANCE_S, _TRY_S, _TRANSIT_S = 3.5e-4, 4e-7, 1e-3, 1.6e-2, 2e-2
"""Work for a look at a state or at what may leave it, for a query of the exact kernel about a tool point, for a look at
the ends of a transfer, for leading the arms through one, and for a way of empty hands to the next (s)."""

_FEW_FOLDS = 4
"""Folds up to which a look costs `_LOOK_S`; with more folds it costs more, in proportion."""


clock_s = time.process_time
"""The clock of every time limit: the processor time of this process (s)."""

wall_clock_s = time.perf_counter
"""The clock that guards against a process that hardly gets a processor, or waits for something (s)."""

WALL_FACTOR, WALL_LEAST_S = 10.0, 5.0
"""The time by the clock on the wall after which a search ends: so many times its time limit, and this much more (s)."""

_GRACE_S = 0.15
"""Time that a step may take after the deadline before it is cut short (s): callers allow half a second in all."""


class OutOfTimeError(Exception):
    """No time was left to validate steps, or no more work was allowed."""


def longest_wait_s(time_limit_s: float) -> float:
    """Return after how long by the clock on the wall a search with a time limit has ended (s)."""
    return WALL_FACTOR * time_limit_s + WALL_LEAST_S


@dataclass(frozen=True, slots=True)
class Deadline:
    """When the time of a search is up: by its own processor time, or much later by the clock on the wall.

    Attributes:
        own_s: by `clock_s`, without what was spent on reach maps, which are built once (s).
        wall_s: by `wall_clock_s` (s).
    """

    own_s: float
    wall_s: float

    @staticmethod
    def after(time_limit_s: float) -> "Deadline":
        """Return the deadline of a search that starts now."""
        return Deadline(_own_s() + time_limit_s, wall_clock_s() + longest_wait_s(time_limit_s))

    @property
    def left_s(self) -> float:
        """The time that is left (s); negative once it is up."""
        return min(self.own_s - _own_s(), self.wall_s - wall_clock_s())


@dataclass(slots=True)
class Budget:
    """The work and the time that a search has left.

    Attributes:
        work_limit_s: the work allowed, in seconds of the machine on which it was measured.
        deadline: when the time is up.
        should_stop: polled as well; true ends the search.
        looks: the number of states, and of deferred successors, looked at.
        beside_s: the work done under separate budgets (s).
    """

    work_limit_s: float
    deadline: Deadline
    should_stop: Callable[[], bool]
    looks: int = 0
    beside_s: float = 0.0
    _problems: list[Problem] = field(default_factory=list)
    _folds: int = 0
    _is_late: bool = False

    @staticmethod
    def of(work_limit_s: float | None, time_limit_s: float, should_stop: Callable[[], bool] | None = None) -> "Budget":
        """Return a budget whose time starts now; without a work limit it allows as much work as time."""
        work_s = time_limit_s if work_limit_s is None else work_limit_s
        return Budget(work_s, Deadline.after(time_limit_s), should_stop or (lambda: False))

    @staticmethod
    def endless(should_stop: Callable[[], bool] | None = None) -> "Budget":
        """Return a budget that is over only when the search is told to stop."""
        return Budget.of(math.inf, math.inf, should_stop)

    def part(self, work_s: float) -> "Budget":
        """Return a budget for a part of the work, with the deadline of the whole."""
        return Budget(work_s, self.deadline, self.should_stop)

    def watch(self, problem: Problem) -> Problem:
        """Start to count the reach queries and joint paths of a problem; return the problem."""
        self._problems.append(problem)
        self._folds = max(self._folds, len(problem.context.sequence.folds))
        return problem

    def limit(self, patience: Patience) -> None:
        """Let a patience end with the time; it knows nothing of the problems watched, whose contexts know it."""
        patience.is_over = partial(_is_past, self.deadline, self.should_stop)
        patience.is_long_over = partial(_is_past, self.deadline, self.should_stop, _GRACE_S)

    @property
    def spent_s(self) -> float:
        """The work done so far (s)."""
        # Asked for at each look: plain loops take a third of what generators took.
        queries = glances = path_requests = transits = 0
        for problem in self._problems:
            queries += problem.context.reach.queries
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
        """Whether the work or the time is used up, or the search was told to stop."""
        if math.isfinite(self.work_limit_s) and self.spent_s > self.work_limit_s:
            return True
        return self.is_late

    @property
    def is_late(self) -> bool:
        """Whether the time is up, whatever work is left, or the search was told to stop; it stays so."""
        self._is_late = self._is_late or _is_past(self.deadline, self.should_stop)
        return self._is_late

    @property
    def left_s(self) -> float:
        """The time that is left, whatever work is (s); negative once it is up."""
        return self.deadline.left_s


def _own_s() -> float:
    """Return the processor time of this process without what was spent on building reach maps (s)."""
    return clock_s() - building_time_s()


def _is_past(deadline: Deadline, should_stop: Callable[[], bool], grace_s: float = 0.0) -> bool:
    """Return whether a deadline is past by some grace (s), or the search was told to stop."""
    return deadline.left_s < -grace_s or should_stop()
