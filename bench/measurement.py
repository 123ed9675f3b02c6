"""Repeated planning of the same cases, and its results.

Cases that are compared run in turns (a, b, a, b, ...), so that a slow moment of the machine affects both, and their
ratio is the median of the ratios of the turns. No search benefits from the one before: each plan has its own memory of
the robot's reach, and the garment is replayed each time. Compiled kernels stay in memory, so `warm_up` loads them
first; joint paths stay too, and are not in the times of searches.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from statistics import median
from time import perf_counter
from typing import Any

from planner import Garment, load_garment
from planner.planning.problem import forget_garments
from planner.planning.robot_task import task_for
from planner.planning.warm_up import compile_kernels
from planner.plans import plan as plan_events
from planner.robots.load_robot import load_robot
from planner.task.task import DEFAULT_ROBOT

TIME_LIMIT_S = 60.0


class BenchmarkError(Exception):
    """Raised where a result that must not depend on machine or moment did."""


@dataclass(frozen=True, slots=True)
class Case:
    """A case to plan: a shipped garment's name, the comfort radius (m) and the heuristic."""

    garment: str
    comfort_radius_m: float
    heuristic: str = "arm_time"


@dataclass(frozen=True, slots=True)
class Outcome:
    """The results that every repetition shares: the plan, and the counts of its search.

    Attributes:
        status: "solved", "infeasible" or, where it is not known whether the plan is the quickest, "budget_exceeded".
        folds: number of folds.
        primitives: primitives in the plan; None unless solved.
        cost_s: the plan's duration (s); None unless solved.
        expanded: states expanded.
        explored: successors pushed.
        ik_queries: queries put to the exact inverse kinematics, points on the comfort circle included.
    """

    status: str
    folds: int
    primitives: int | None
    cost_s: float | None
    expanded: int
    explored: int
    ik_queries: int


@dataclass(frozen=True, slots=True)
class Measurement:
    """A case, its outcome, and the times of each repetition, in order.

    Attributes:
        case: the case planned.
        outcome: its outcome.
        ik_times_s: time in inverse kinematics (s).
        told_times_s: time until a plan, or that there is none, is first told (s).
        search_times_s: time of the search, inverse kinematics and trying of reasons included (s).
        plan_times_s: time of the whole call, the Fold-DAG included (s).
    """

    case: Case
    outcome: Outcome
    ik_times_s: tuple[float, ...]
    told_times_s: tuple[float, ...]
    search_times_s: tuple[float, ...]
    plan_times_s: tuple[float, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the outcome, and the median of each time."""
        return {
            **asdict(self.case),
            **asdict(self.outcome),
            "ik_time_s": median(self.ik_times_s),
            "told_time_s": median(self.told_times_s),
            "search_time_s": median(self.search_times_s),
            "plan_time_s": median(self.plan_times_s),
        }


@dataclass(frozen=True, slots=True)
class _Run:
    outcome: Outcome
    ik_time_s: float
    told_time_s: float
    search_time_s: float
    plan_time_s: float


@dataclass(frozen=True, slots=True)
class Ratio:
    """The ratio of a time to its peer's: median, least and largest over the turns."""

    median: float
    least: float
    most: float

    @classmethod
    def of(cls, times_s: Sequence[float], peer_times_s: Sequence[float]) -> "Ratio":
        """Return the ratio of times measured in turns; both sequences have the same length."""
        ratios = [time / peer for time, peer in zip(times_s, peer_times_s, strict=True)]
        return cls(median(ratios), min(ratios), max(ratios))

    def __str__(self) -> str:
        return f"{self.median:.2f} ({self.least:.2f}..{self.most:.2f})"


def warm_up() -> None:
    """Compile or load the kernels, and make one plan that is not measured."""
    compile_kernels()
    _run(load_garment("hand-towel"), Case("hand-towel", 0.03))


def measure(*cases: Case, repetitions: int) -> list[Measurement]:
    """Plan the cases in turns, `repetitions` times each, after a turn that is not measured.

    What stays known from the first plan of a process saves later ones some questions (65 of 66,000 for half a scarf).

    Raises:
        BenchmarkError: a case had another outcome than the time before (unless a search ran out of time).
    """
    garments = [load_garment(case.garment) for case in cases]
    turns = [[_run(*pair) for pair in zip(garments, cases, strict=True)] for _ in range(1 + repetitions)]
    return [_measurement(case, runs) for case, *runs in zip(cases, *turns[1:], strict=True)]


def _run(garment: Garment, case: Case) -> _Run:
    started = perf_counter()
    forget_garments()
    load_robot(DEFAULT_ROBOT).forget_reach()
    task = task_for(
        garment,
        None,
        comfort_radius_m=case.comfort_radius_m,
        heuristic=case.heuristic,
        time_limit_s=TIME_LIMIT_S,
    )
    told_s: list[float] = []
    for event in plan_events(task):
        told_s.append(perf_counter() - started)
        plan = event.found.plan
    plan_time_s = told_s[-1]
    found = plan.statistics
    outcome = Outcome(
        "budget_exceeded" if plan.statistics.is_cut_short else plan.status,
        len(garment.folds),
        len(plan.primitives) if not found.is_cut_short and plan.is_solved else None,
        plan.cost_s if not found.is_cut_short else None,
        found.expanded,
        found.explored,
        found.ik_queries,
    )
    return _Run(outcome, found.ik_time_s, told_s[0], found.search_time_s, plan_time_s)


def _measurement(case: Case, runs: Sequence[_Run]) -> Measurement:
    outcomes = {run.outcome for run in runs}
    if len(outcomes) > 1 and all(outcome.status != "budget_exceeded" for outcome in outcomes):
        raise BenchmarkError(f"{case} did not come out the same every time: {outcomes}")
    return Measurement(
        case,
        runs[0].outcome,
        tuple(run.ik_time_s for run in runs),
        tuple(run.told_time_s for run in runs),
        tuple(run.search_time_s for run in runs),
        tuple(run.plan_time_s for run in runs),
    )
