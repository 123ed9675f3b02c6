"""The answer to a cell: a row of the table, how long it took, and its plan where that is kept.

A row holds nothing that depends on the machine or the moment, so two runs of a study give the same table.
"""

import gzip
import hashlib
import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from app.comparison import comfort_margin_m
from app.studies.cell import Cell
from app.studies.rehearsed import rehearsed
from planner.planning.margins import margins_of
from planner.task.plan import Plan
from planner.task.task import Task

FAILED = "failed"
"""The status of a cell that has no answer."""

SOLVED, INFEASIBLE, OUT_OF_BUDGET = "solved", "infeasible", "budget_exceeded"

RESULT_COLUMNS: Mapping[str, type] = {
    "x_m": float,
    "y_m": float,
    "yaw_rad": float,
    "status": str,
    "cost_s": float,
    "bound_s": float,
    "is_proven": bool,
    "folds": int,
    "steps": int,
    "reason_codes": str,
    "reason_folds": str,
    "short_by_m": float,
    "reachable_comfort_m": float,
    "reach_margin_m": float,
    "reach_margin_step": int,
    "grips_margin_m": float,
    "friction_margin": float,
    "edge_margin_m": float,
    "plan_id": str,
    "error": str,
}
"""The columns of a row after its axes: where the garment lies, what came out, and why."""

COMFORT_MARGIN = "comfort_margin_m"
"""The column of the margin that takes further plans, there only where a study asks for it."""

TIMING_COLUMNS = ("wall_s", "cpu_s", "search_s", "joint_s", "ik_queries")

MakePlan = Callable[[Task], Plan]


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer to a cell.

    Attributes:
        index: the cell's number.
        row: the values of `RESULT_COLUMNS`, and of what else the study asks for.
        timing: the values of `TIMING_COLUMNS`, as far as they are known.
        plan: the plan's file, compressed; None where it is not kept.
    """

    index: int
    row: Mapping[str, Any]
    timing: Mapping[str, float]
    plan: bytes | None = None


def answered(cell: Cell, make_plan: MakePlan, *, keep_plan: bool = False) -> Answer:
    """Return the answer to a cell; any exception becomes its error."""
    began_s, cpu_s = time.perf_counter(), time.process_time()
    if cell.task is None:
        return failed(cell, cell.error or "")
    try:
        plan = make_plan(cell.task)
        planned_s, margins = time.process_time() - cpu_s, _margins(plan)
        if cell.has_comfort_margin and plan.is_solved:
            margins[COMFORT_MARGIN] = comfort_margin_m(cell.task, make_plan)
        held = rehearsed(plan, cell.rehearsal) if cell.rehearsal is not None and plan.is_solved else {}
    except Exception as error:
        return failed(cell, f"{type(error).__name__}: {error}")
    timing = {
        "wall_s": time.perf_counter() - began_s,
        "cpu_s": time.process_time() - cpu_s,
        "search_s": plan.statistics.search_time_s,
        "joint_s": plan.statistics.joint_time_s,
        "ik_queries": float(plan.statistics.ik_queries),
    }
    kept = gzip.compress(json.dumps(plan.to_dict()).encode(), mtime=0) if keep_plan else None
    return Answer(cell.index, {**_row(plan, planned_s), **margins, **held}, timing, kept)


def failed(cell: Cell, error: str) -> Answer:
    """Return the answer to a cell that has none, with the reason."""
    row = dict.fromkeys(RESULT_COLUMNS) | _lying(cell.task) | {"status": FAILED, "error": error}
    return Answer(cell.index, row, {})


def plan_id(task: Task) -> str:
    """Return the name of a task's plan: a digest of the task, since equal tasks have equal plans."""
    return hashlib.sha256(json.dumps(task.to_dict(), sort_keys=True).encode()).hexdigest()[:16]


def _lying(task: Task | None) -> dict[str, float]:
    return {} if task is None else task.start.placement.to_dict()


def _margins(plan: Plan) -> dict[str, Any]:
    """Return the margins that can be read from a plan."""
    found = margins_of(plan)
    if found is None:
        return {}
    return {
        "reach_margin_m": found.reach_m,
        "reach_margin_step": found.reach_step,
        "grips_margin_m": found.grips_m,
        "friction_margin": found.friction,
        "edge_margin_m": found.edge_m,
    }


def _row(plan: Plan, cpu_s: float) -> dict[str, Any]:
    """Return the row of a plan found in some processor time (s).

    Of all that is short, it tells the least, for that is what to mend first.
    """
    short = [reason.short_by_m for reason in plan.reasons if reason.short_by_m is not None]
    comfort = [reason.comfort_m for reason in plan.reasons if reason.comfort_m is not None]
    folds = sorted({reason.fold for reason in plan.reasons if reason.fold is not None})
    limit_s = plan.task.limits.time_limit_s
    is_late = plan.statistics.is_cut_short and cpu_s >= limit_s
    return {
        **dict.fromkeys(RESULT_COLUMNS),
        **_lying(plan.task),
        "status": plan.status,
        "cost_s": plan.cost_s,
        "bound_s": plan.bound_s,
        "is_proven": plan.is_proven,
        "folds": len(plan.garment.folds),
        "steps": len(plan.steps),
        "reason_codes": " ".join(sorted({reason.code.value for reason in plan.reasons})),
        "reason_folds": " ".join(map(str, folds)),
        "short_by_m": min(short, default=None),
        "reachable_comfort_m": min(comfort, default=None),
        "plan_id": plan_id(plan.task),
        "error": f"the time limit of {limit_s:g} s ended the search" if is_late else None,
    }
