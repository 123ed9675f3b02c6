"""Hands that are to follow paths, and what the base may do meanwhile: `planner.robot.driving`, for one robot."""

from collections.abc import Callable
from time import thread_time

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.robot.driving import least_driving
from planner.robot.driving_incumbents import ANY, EVERY, UNBEATEN
from planner.robot.driving_task import Task

_WANTED = {"unbeaten": UNBEATEN, "every": EVERY, "any": ANY}


class Following:
    """One or two hands that are to follow paths."""

    def __init__(self, task: Task, charge: Callable[[float], None]) -> None:
        """`charge` is told the time that is spent (s)."""
        self._task = task
        self._charge = charge

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """How the base may drive meanwhile, in as few steps as can be.

        Args:
            begun: for each back-off the steps in which the base can be there when the hands begin; `IMPOSSIBLE`
                where it cannot. Shape (count,), count at most 32.
            most: ways of more steps are not looked for.
            wanted: which ends are wanted.
        """
        started = thread_time()
        answer, more = least_driving(self._task, begun, most, _WANTED[wanted])
        self._charge(thread_time() - started)
        return Driving(answer[0], answer[1], answer[2:], more)
