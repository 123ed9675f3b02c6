"""The camera that follows the work: from across the table, so that the robot never hides its own hands.

The work jumps from place to place with each step. The camera approaches it gradually, by a share in each frame. At the
end it comes nearer and higher, to look at the packet over the hands.
"""

import math

import numpy as np

from app.ui.viewpoint import Viewpoint
from app.ui.viewpoints.presets import Lens
from planner.geometry.pose import Point2, Pose2, wrapped_angle
from planner.task.plan import Plan

ASIDE_RAD = math.radians(50.0)
"""The camera's angle beside the line from the robot through its work (rad); 0 would be face to face."""

_RISE_RAD = (math.radians(36.0), math.radians(52.0))
"""How steeply the camera looks down at the work, and at the packet (rad)."""

_HALF_M = ((0.85, 0.6), (0.5, 0.35))
"""Half the width and height of the region that the camera keeps in view round the work, and round the packet (m)."""

_SHARE = 0.12
"""Share of the distance to its target that the camera covers in each frame."""


class Following:
    """A camera that approaches the work frame by frame."""

    def __init__(self) -> None:
        """Begin without a view: the first one is on the work at once."""
        self._work: Point2 | None = None
        self._heading_rad = 0.0
        self._nearness = 0.0

    def view(self, base: Pose2, work: Point2, lens: Lens, *, is_over: bool = False) -> Viewpoint:
        """Return the next viewpoint.

        Args:
            base: where the robot stands, table frame.
            work: the middle of its work (m).
            lens: the camera.
            is_over: whether the work is done.
        """
        heading_rad = math.atan2(work[1] - base.y_m, work[0] - base.x_m)
        if self._work is None:
            self._work, self._heading_rad = work, heading_rad
        (x, y), (u, v) = self._work, work
        self._work = (x + _SHARE * (u - x), y + _SHARE * (v - y))
        self._heading_rad += _SHARE * wrapped_angle(heading_rad - self._heading_rad)
        self._nearness += _SHARE * (float(is_over) - self._nearness)
        return _across(self._work, self._heading_rad, lens, self._nearness)


def _across(work: Point2, heading_rad: float, lens: Lens, nearness: float) -> Viewpoint:
    """Return the view of some work from beyond it and to the side, for a robot that works with a heading (rad)."""
    far_m, near_m = (lens.distance(*half) for half in _HALF_M)
    distance, turn_rad = far_m + nearness * (near_m - far_m), heading_rad + ASIDE_RAD
    rise_rad = _RISE_RAD[0] + nearness * (_RISE_RAD[1] - _RISE_RAD[0])
    level = distance * math.cos(rise_rad)
    x, y = work[0] + level * math.cos(turn_rad), work[1] + level * math.sin(turn_rad)
    return Viewpoint((x, y, distance * math.sin(rise_rad)), (work[0], work[1], 0.1))


def work_of(plan: Plan, t_s: float) -> Point2:
    """Return the middle of what the hands do in the step at a time, or of the cloth when they do nothing (m)."""
    step = next((step for step in plan.steps if t_s < step.end_s), None)
    if step is not None and step.grips:
        points = np.array([point[:2] for grip in step.grips for point in (grip.pick, grip.place)])
    else:
        world = plan.end if step is None else step.before
        low_x, low_y, high_x, high_y = plan.sequence.cloth(world.done).silhouette.bounds
        points = world.placement.to_outer(np.array([(low_x, low_y), (high_x, high_y)]))
    x, y = points.mean(axis=0)
    return (float(x), float(y))
