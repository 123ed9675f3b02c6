"""Hands that follow paths, and the driving of the base meanwhile: `planner.robots.driving`, for one robot."""

from collections.abc import Callable
from time import thread_time

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.robots.driving import least_driving
from planner.robots.driving_incumbents import ANY, EVERY, UNBEATEN
from planner.robots.driving_task import DrivingTask

_WANTED = {"unbeaten": UNBEATEN, "every": EVERY, "any": ANY}


class FollowingPaths:
    """Hands that follow paths."""

    def __init__(self, task: DrivingTask, charge: Callable[[float], None]) -> None:
        """Take the task; `charge` is called with the time spent on each query (s)."""
        self._task = task
        self._charge = charge

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """Return how the base may drive meanwhile, in as few steps as possible.

        Args:
            begun: for each standoff the steps in which the base can be there when the hands begin; `IMPOSSIBLE` where
                it cannot. Shape (count,), count at most 32.
            most: the largest number of steps considered.
            wanted: which ends are wanted.
        """
        started = thread_time()
        answer, more = least_driving(self._task, begun, most, _WANTED[wanted])
        self._charge(thread_time() - started)
        return Driving(answer[0], answer[1], answer[2:], more)
