"""Planners that answer at once, and planners that misbehave; light to import, for workers do."""

import os
import signal
import time
from dataclasses import replace
from pathlib import Path

from planner.task.plan import Plan, Statistics
from planner.task.task import Task
from tests.patience import FOR_EVER_S


def fake_plan(task: Task) -> Plan:
    """Return at once that there is no plan, or one of no steps where the table is low."""
    is_low = task.scene.table.height_m < 0.8
    numbers = Statistics(0, 0, 0, 0.0, 0.0, 0.0, 0.0)
    return Plan(task, "solved" if is_low else "infeasible", (), None, (), numbers, True)


def raising(task: Task) -> Plan:
    """Fail on the table that is 0.75 m high."""
    if task.scene.table.height_m == 0.75:
        raise ValueError("the planner stumbles")
    return fake_plan(task)


def deadly(task: Task) -> Plan:
    """End the process on the table that is 0.75 m high."""
    if task.scene.table.height_m == 0.75:
        os.kill(os.getpid(), signal.SIGKILL)
    return fake_plan(task)


def deadly_once(marker: Path, task: Task) -> Plan:
    """End the process on the table that is 0.75 m high, unless a file says that this has been done."""
    if task.scene.table.height_m == 0.75 and not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return fake_plan(task)


def hanging(task: Task) -> Plan:
    """Never answer on the table that is 0.75 m high."""
    if task.scene.table.height_m == 0.75:
        time.sleep(FOR_EVER_S)
    return fake_plan(task)


def late(task: Task) -> Plan:
    """Give up for lack of time."""
    begun_s = time.process_time()
    while time.process_time() < begun_s + task.limits.time_limit_s:
        pass
    found = fake_plan(task)
    return replace(found, status="budget_exceeded", statistics=replace(found.statistics, is_cut_short=True))
