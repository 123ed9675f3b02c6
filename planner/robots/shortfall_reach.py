"""A robot's reach with the shortfalls of places out of reach: for explanations, and to tell what is hopeless."""

import math
from abc import ABC, abstractmethod
from time import thread_time

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.pose import FloatArray
from planner.geometry.shortfall import Shortfall
from planner.robots.comfort_reach import ComfortReach


class ShortfallReach(ComfortReach, ABC):
    """The reach of a robot with its lift at one height, for one comfort radius; implements `Reach`."""

    def shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float = math.inf,
        deadline: Deadline = ENDLESS,
    ) -> Shortfall | None:
        """Return by how much and why a place is not within the comfort radius (see `Shortfalls`).

        Displacements up to 0.8 m are tried, along eight horizontal directions, straight down and straight up. Raises
        `ValueError` if there is no approach.
        """
        if len(approaches) == 0:
            raise ValueError("without an approach no point is within reach")
        points = np.reshape(points, (-1, 3))
        if self.from_anywhere(arm, points, approaches, 1, 0.0).any():
            return None
        started = thread_time()
        found, queries = self._least_shortfall(arm, points, approaches, at_most_m, deadline)
        self._shortfall_queries += queries
        self._query_time_s += thread_time() - started
        return found

    @abstractmethod
    def _least_shortfall(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        at_most_m: float,
        deadline: Deadline,
    ) -> tuple[Shortfall, int]:
        """Return the least shortfall of a place that is not within the comfort radius, and the queries it took."""
