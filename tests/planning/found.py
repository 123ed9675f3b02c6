"""Plans with the context, segments and joint paths of their search, which a plan itself does not hold."""

from typing import Unpack

from planner import Garment, Scene, Task, find_plan
from planner.planning.found_plan import FoundPlan
from planner.task.task import TaskOptions


def found_plan(cloth: Garment, scene: Scene | None = None, **options: Unpack[TaskOptions]) -> FoundPlan:
    """Return what `find_plan` finds for a garment."""
    return find_plan(Task.of(cloth, scene, **options))
