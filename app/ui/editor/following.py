"""The camera that follows the work: from across the table, so that the robot is behind its hands and never before them.

What is looked at moves in jumps, from step to step. The camera goes after it a share of the way at each picture.
"""

import math

import numpy as np

from app.document_state import Film
from app.ui.editor.presets import Lens
from app.ui.viewpoint import Viewpoint
from planner.geometry.pose import Point2, Pose2, wrapped_angle

ASIDE_RAD = math.radians(50.0)
"""How far to the side of the line from the robot through its work the camera stands; 0 would be face to face (rad)."""

_RISE_RAD = math.radians(36.0)
_HALF_M = (0.85, 0.6)
"""What is in the picture on each side of the work, across and upwards (m)."""

_SHARE = 0.12
"""Share of the way to where it wants to be that the camera goes at each picture."""


class Following:
    """A camera on its way after the work."""

    def __init__(self) -> None:
        """Begin where the work is first."""
        self._work: Point2 | None = None
        self._heading_rad = 0.0

    def view(self, base: Pose2, work: Point2, lens: Lens) -> Viewpoint:
        """Return the next viewpoint.

        Args:
            base: where the robot stands, table frame.
            work: the middle of its work (m).
            lens: the camera.
        """
        heading_rad = math.atan2(work[1] - base.y_m, work[0] - base.x_m)
        if self._work is None:
            self._work, self._heading_rad = work, heading_rad
        (x, y), (u, v) = self._work, work
        self._work = (x + _SHARE * (u - x), y + _SHARE * (v - y))
        self._heading_rad += _SHARE * wrapped_angle(heading_rad - self._heading_rad)
        return across(self._work, self._heading_rad, lens)


def across(work: Point2, heading_rad: float, lens: Lens) -> Viewpoint:
    """Return the view of some work from beyond it and to the side, for a robot that works with a heading (rad)."""
    distance, turn_rad = lens.distance(*_HALF_M), heading_rad + ASIDE_RAD
    level = distance * math.cos(_RISE_RAD)
    x, y = work[0] + level * math.cos(turn_rad), work[1] + level * math.sin(turn_rad)
    return Viewpoint((x, y, distance * math.sin(_RISE_RAD)), (work[0], work[1], 0.1))


def work_of(film: Film, t_s: float) -> Point2:
    """Return the middle of what the hands do in the step at a time, or of the cloth while they do nothing (m)."""
    plan = film.plan
    step = next((step for step in plan.steps if t_s < step.end_s), plan.steps[-1] if plan.steps else None)
    if step is not None and step.grips:
        points = np.array([point[:2] for grip in step.grips for point in (grip.pick, grip.place)])
    else:
        world = plan.end if step is None else step.before
        low_x, low_y, high_x, high_y = plan.sequence.cloth(world.done).silhouette.bounds
        points = world.placement.to_outer(np.array([(low_x, low_y), (high_x, high_y)]))
    x, y = points.mean(axis=0)
    return (float(x), float(y))
