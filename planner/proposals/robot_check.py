"""Ask whether the robot can do folds, one by one, before a whole plan is looked for.

To plan a packet takes a second, and most packets that a robot cannot do fail by a single fold: it lies too far away,
its arc is too high, or it needs more hands than there are. So each fold is tried alone as soon as it is made, from
where the folds before left robot and cloth: at each station, with the cloth where a few drags bring it. This takes some
hundredths of a second. It proves nothing: folds that can be done alone may have no plan, and other drags may help. So
what the robot cannot do is not left out, it comes later.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from planner.cloth.garment import DrawnFold
from planner.geometry.pose import Point2
from planner.planning.problem import Problem
from planner.planning.warm_up import compile_kernels
from planner.primitives.context import Context
from planner.primitives.drag_way import arm_drag_steps, arm_dragged, dragged, longest_drag
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import fold_trials
from planner.primitives.fold_way import can_follow
from planner.primitives.state import State
from planner.task.task import Task

_DRAGS, _ARM_DRAGS = 6, 2
"""Steps of drags that are tried: towards a robot that drives, and by arms in each direction."""

DOUBT_EFFORT, _MOVE_EFFORT, _DRAG_EFFORT, _DRAG_EFFORT_PER_M = 4.0, 0.3, 0.1, 0.2
"""The efforts of a fold that the robot probably cannot do, of going to another station, and of a drag."""


@dataclass(frozen=True, slots=True)
class Stand:
    """Where a robot and the cloth are.

    Attributes:
        station: the index of the robot's station.
        offset: how far the cloth was dragged (m).
    """

    station: int
    offset: Point2 = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Checked:
    """What folds mean to a robot.

    Attributes:
        effort: what they add to the effort of the packet.
        doubts: how many of them it probably cannot do.
        stand: where robot and cloth are after them.
    """

    effort: float
    doubts: int
    stand: Stand


class RobotCheck:
    """Looks for a stand for each fold."""

    def __init__(self, task: Task) -> None:
        """Prepare the check; the robot is loaded once it is queried."""
        self._task = task

    @cached_property
    def _problem(self) -> Problem:
        compile_kernels(self._task.robot)
        return Problem.of(self._task)

    @property
    def start(self) -> Stand:
        """Where robot and cloth are before any fold."""
        return Stand(self._problem.start.station)

    def of(self, folds: tuple[DrawnFold, ...], first: int, stand: Stand) -> Checked:
        """Return what folds from the first one on mean to the robot, from where those before left it."""
        context = self._problem.varied(garment=replace(self._problem.task.garment, folds=folds)).context
        effort, doubts = 0.0, 0
        for fold in range(first, len(folds)):
            there = stand if folds[fold].is_red else next(_stands(context, fold, stand), None)
            if there is None:
                effort, doubts = effort + DOUBT_EFFORT, doubts + 1
                continue
            drag_m = math.dist(there.offset, stand.offset)
            effort += _MOVE_EFFORT * (there.station != stand.station)
            effort += _DRAG_EFFORT * (drag_m > 0.0) + _DRAG_EFFORT_PER_M * drag_m
            stand = there
        return Checked(effort, doubts, stand)


def _stands(context: Context, fold: int, stand: Stand) -> Iterator[Stand]:
    """Yield from where a fold can be done: from the last station, then from others, after few drags first."""
    for there in _places(context, stand):
        state = State((1 << fold) - 1, there.offset, there.station, 0)
        if geometric_obstacle(context, state, fold) is None and any(
            can_follow(context, there.station, trial) for trial in fold_trials(context, state, fold)
        ):
            yield there


def _places(context: Context, stand: Stand) -> Iterator[Stand]:
    if context.is_fixed:
        yield stand
        for steps in range(1, _ARM_DRAGS + 1):
            for step in arm_drag_steps(context, stand.station):
                yield replace(stand, offset=arm_dragged(stand.offset, step, steps))
        return
    most = min(longest_drag(context), _DRAGS)
    for station in sorted(range(len(context.scene.stations)), key=lambda station: station != stand.station):
        for steps in range(most + 1):
            yield Stand(station, dragged(context, stand.offset, station, steps) if steps else stand.offset)
