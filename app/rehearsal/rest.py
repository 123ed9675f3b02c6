"""The rest of a plan as a task to plan anew."""

from dataclasses import replace

from planner.task.task import TIME_LIMIT_S, Task
from planner.task.world_state import WorldState


def rest_task(task: Task, start: WorldState) -> Task:
    """Return the task of the rest from a state.

    The work ends its search, on any machine and under any load, so that a run twice is the same.

    Args:
        task: the task as it was at first.
        start: the state as it is.
    """
    limits = task.limits
    work_s = limits.work_limit_s or limits.time_limit_s
    return replace(task, start=start, limits=replace(limits, work_limit_s=work_s, time_limit_s=TIME_LIMIT_S[1]))
