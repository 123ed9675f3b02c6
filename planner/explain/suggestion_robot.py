"""Suggest another robot, at the table and the place that suit it: the quickest of those that can fold the garment.

The robots are tried one after the other, each proven by its plan; who asks says which there are.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from planner.errors import FoldingError
from planner.explain.suggestion_budget import TimeUpError
from planner.explain.suggestion_trial import Search, SuggestionTrial, each_cheaper
from planner.geometry.pose import Pose2
from planner.planning.robot_task import default_scene, near_placement, task_for
from planner.planning.warm_up import compile_kernels
from planner.robots.load_robot import prepare_robot, robot_card_file
from planner.robots.varied_card import split_changes
from planner.task.task import DEFAULT_ROBOT, Task
from planner.words.catalogue import worded


def robots(task: Task, names: Iterable[str], on_map: Callable[[float], None]) -> Search:
    """Look for a robot that can fold the garment, and then for quicker ones.

    Args:
        task: the task; nothing is tried once a fold is done, since cloth is not carried to another table.
        names: the robots to try, each taken only when it is its turn. The task's own is left out, and so is one that
            cannot be loaded.
        on_map: is told how far the maps of a robot's arms are where they must be built, which may take up to a minute;
            may raise `TimeUpError`, with which the search ends.
    """
    own = split_changes(task.robot)[0]
    others = () if task.start.folds_done else (name for name in names if name != own)
    return each_cheaper(_trials(task, others, on_map))


def _trials(task: Task, names: Iterable[str], on_map: Callable[[float], None]) -> Iterator[SuggestionTrial]:
    for name in names:
        try:
            title = robot_card_file(name).title
            prepare_robot(name, on_map)
            compile_kernels(name)
            other = replace(task_for(task.garment, robot=name, placement=_placement(task, name)), limits=task.limits)
        except TimeUpError:
            return
        except FoldingError:
            continue  # a robot of one's own whose files are gone helps nobody
        start = other.start
        change = {
            "robot": name,
            "scene": other.scene.to_dict(),
            "placement": start.placement.to_dict(),
            "start_station": start.base.station,
        }
        yield SuggestionTrial("robot", worded("other_robot", {"robot": name, "title": title}), change, 1.0, other)


def _placement(task: Task, robot: str) -> Pose2 | None:
    """Return where the garment would lie; None for where the robot's card says, which the default robot's does not."""
    if robot != DEFAULT_ROBOT:
        return None
    return near_placement(task.garment, default_scene(robot).table, task.start.placement.yaw_rad)
