"""The functions that run in processes of their own; their arguments and results are picklable."""

import os
from dataclasses import dataclass
from typing import Any

from app.files.crease_reading import Creases
from app.files.import_file import Imported, import_file
from app.jobs.apart import Tell
from planner import make_plan
from planner.explain.suggestion_map import PlacementMap, placement_map
from planner.explain.suggestions import suggestions
from planner.planning.plan_check import require_replay
from planner.task.plan import Plan
from planner.task.task import Task


@dataclass(frozen=True, slots=True)
class Suggested:
    """A suggestion as JSON, and the plan that proves it."""

    body: dict[str, Any]
    plan: Plan


@dataclass(frozen=True, slots=True)
class Tried:
    """A change that is being planned, as JSON."""

    body: dict[str, Any]


_NICENESS = 10
"""Niceness of a search for suggestions: people who draw and the plans of their drawings come first."""


def plan(_: Tell, task: Task) -> Plan:
    """Plan a task, as `make_plan` does."""
    return make_plan(task)


def read_plan(_: Tell, data: dict[str, Any]) -> Plan:
    """Read a plan file and replay the plan; raise the first error, naming the step."""
    plan = Plan.from_dict(data)
    require_replay(plan)
    return plan


def suggest(tell: Tell, task: Task, known: Plan | None) -> bool:
    """Send None once the request is valid, then each trial and suggestion; return whether all were tried to the end."""
    os.nice(_NICENESS)
    found = suggestions(
        task, plan=known, on_trial=lambda trial: tell(Tried({"kind": trial.kind, "says": trial.says.to_dict()}))
    )
    tell(None)
    while True:
        try:
            suggestion = next(found)
        except StopIteration as end:
            return bool(end.value)
        tell(Suggested(suggestion.to_dict(), suggestion.plan))


def map_places(_: Tell, task: Task, step_m: float) -> PlacementMap:
    """Plan for every placement of the garment, as `placement_map` does."""
    return placement_map(task, step_m=step_m)


def read_file(
    _: Tell, filename: str, data: bytes, units: str | None, scale: float, creases: Creases | None
) -> Imported:
    """Read a garment from a file, as `import_file` does."""
    return import_file(filename, data, units, scale, creases)
