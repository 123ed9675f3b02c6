"""The order of the arms' joints in a configuration.

A configuration of a robot is one row: the joints of all arms, one arm after the other. So arms may have different
numbers of joints, and one array, shape (n, joints), holds a whole motion.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.card import RobotCard


@dataclass(frozen=True, slots=True, eq=False)
class JointLayout:
    """The joints of all arms in a configuration.

    Attributes:
        spans: each arm's part of a configuration.
        owners: the arm of each joint, shape (joints,).
        home: all arms out of the way (rad), shape (joints,).
        speeds_rad_s: the top speeds, shape (joints,).
        accelerations: the top accelerations (rad/s2), shape (joints,).
        is_continuous: which joints turn without end, shape (joints,).
        is_lifting: which joints raise an arm's elbow and hand, shape (joints,).
        ranges: the lowest and highest values (rad, m), infinite for endless joints, shape (joints, 2).
    """

    spans: tuple[slice, ...]
    owners: NDArray[np.int64]
    home: FloatArray
    speeds_rad_s: FloatArray
    accelerations: FloatArray
    is_continuous: BoolArray
    is_lifting: BoolArray
    ranges: FloatArray

    @staticmethod
    def of(card: RobotCard) -> "JointLayout":
        """Return the layout of a robot's arms, from left to right."""
        counts = [len(arm.joint_names) for arm in card.arms]
        ends = np.cumsum([0, *counts]).tolist()
        lifting = [name in arm.lifting for arm in card.arms for name in arm.joint_names]
        return JointLayout(
            tuple(slice(start, end) for start, end in pairwise(ends)),
            np.repeat(np.arange(len(counts)), counts),
            np.array([q for arm in card.arms for q in arm.home], dtype=float),
            np.array([speed for arm in card.arms for speed in arm.speeds_rad_s], dtype=float),
            np.array([own for arm in card.arms for own in arm.kept_accelerations], dtype=float),
            np.array([turns for arm in card.arms for turns in arm.is_continuous], dtype=np.bool_),
            np.array(lifting, dtype=np.bool_),
            np.array([ends for arm in card.arms for ends in arm.limits], dtype=float),
        )

    @property
    def arms(self) -> range:
        """The arms' indices."""
        return range(len(self.spans))

    def at_home(self, count: int) -> FloatArray:
        """Return configurations with all arms at home, shape (count, joints); a new array."""
        return np.tile(self.home, (count, 1))

    def joints_of(self, arms: Iterable[int]) -> slice | NDArray[np.int64]:
        """Return the indices of some arms' joints in a configuration; arms in rising order."""
        chosen = tuple(arms)
        if chosen == tuple(self.arms):
            return slice(None)
        return np.flatnonzero(np.isin(self.owners, chosen))
