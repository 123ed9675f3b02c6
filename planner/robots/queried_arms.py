"""A robot's arms as the queries for reach see them."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Approach, FloatArray
from planner.robots.arm_query import ArmNumbers


class ReachingArm(Protocol):
    """An arm as the compiled queries see it."""

    def shoulder(self, torso_m: float) -> FloatArray:
        """Return its shoulder in its own frame with the lift raised (m), shape (3,)."""
        ...

    def mirrored_places(self, places: FloatArray) -> FloatArray:
        """Return points of the base frame, shape (..., 3), in the arm's own frame; a new array."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class QueriedArms:
    """The arms of a robot, and how the compiled queries are asked about them.

    Attributes:
        names: the arms from left to right.
        arms: the same arms.
        numbers: what the queries compute with; one arm's where the others are its mirror images.
        approaches: the directions from which the grippers may pinch cloth, base frame.
        labels: for each arm the memory's label of each approach.
    """

    names: tuple[str, ...]
    arms: tuple[ReachingArm, ...]
    numbers: ArmNumbers
    approaches: tuple[Approach, ...]
    labels: tuple[NDArray[np.int64], ...]
