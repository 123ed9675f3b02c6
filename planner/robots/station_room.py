"""Stations at which the base of a robot that drives would stand in the table or its legs."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from planner.geometry.pose import Pose2

_STEP_M, _FURTHEST_M = 0.01, 1.0
"""Room further back is looked for in such steps, and so far back at most (m)."""


class Standing(Protocol):
    """A check of where a base may stand."""

    def body_free(self, base_in_table: Pose2) -> bool:
        """Return whether the robot without its arms stays clear of the table."""
        ...


@dataclass(frozen=True, slots=True)
class StationInTable:
    """A station at which the base touches the table.

    Attributes:
        station: its name.
        back_m: how much further back the base stands free (m); None where it does not within a metre.
    """

    station: str
    back_m: float | None


def stations_in_table(stations: tuple[tuple[str, Pose2], ...], table: Standing) -> tuple[StationInTable, ...]:
    """Return the stations at which the base touches the table.

    Args:
        stations: base poses in the table frame by name.
        table: the check of where the base may stand at the table.
    """
    return tuple(StationInTable(name, _back_m(pose, table)) for name, pose in stations if not table.body_free(pose))


def _back_m(pose: Pose2, table: Standing) -> float | None:
    steps = np.arange(1, round(_FURTHEST_M / _STEP_M) + 1)
    return next((float(step * _STEP_M) for step in steps if table.body_free(pose.ahead(-float(step) * _STEP_M))), None)
