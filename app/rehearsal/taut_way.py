"""Keep cloth that is folded over from going slack between the hands and the fold line.

On a plan's path a hand halfway down is nearer to the fold line than its cloth is long, by .29 of it, and two hands at
different distances from the line come nearer to each other. Cloth that bends in loops does not lie down behind them as
the plan has it: the slack stands up, draws the crease inside of its line, and springs back when it is let go. A flap
that turned about the line as a stiff sheet would have no slack, but one that is long hangs through and would pull at
the stack. So hands go half of the way from the one to the other, and leave their paths by so much at most as is in
reach.
"""

import math
from dataclasses import replace

import numpy as np

from app.rehearsal.world import GripMotion, StepMotion, way_done
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M

_SHARE = 0.5
"""How far hands go from their planned paths to those about the line, at most."""

_POINTS = 61


def taut(motion: StepMotion, most_m: float) -> StepMotion:
    """Return a fold in which hands keep the cloth between them and the line longer; other steps as they are.

    It begins and ends as planned. Hands that hold cloth before or after it, and those that do not cross a line, keep
    their paths.

    Args:
        motion: the step.
        most_m: how far hands may leave their paths (m).
    """
    if not motion.is_fold or not all(grip.closes and grip.opens for grip in motion.grips):
        return motion
    farthest = max(motion.grips, key=_crossed_m, default=None)
    if farthest is None or min(map(_crossed_m, motion.grips)) <= LENGTH_M:
        return motion
    times_s = np.linspace(farthest.times_s[0], farthest.times_s[-1], _POINTS)
    done = np.interp(times_s, farthest.times_s, way_done(np.array(farthest.points)))
    planned = [np.array([grip.at(t_s) for t_s in times_s.tolist()]) for grip in motion.grips]
    beside = [_turned_over(points, done) - points for points in planned]
    furthest_m = max(float(np.linalg.norm(offsets, axis=1).max()) for offsets in beside)
    share = min(_SHARE, max(0.0, most_m) / max(furthest_m, LENGTH_M))
    grips = zip(motion.grips, planned, beside, strict=True)
    return replace(
        motion, grips=tuple(_along(grip, times_s, points + share * offsets) for grip, points, offsets in grips)
    )


def _crossed_m(grip: GripMotion) -> float:
    """Return how far a hand goes over the table from its first point to its last (m)."""
    return math.dist(grip.points[0][:2], grip.points[-1][:2])


def _turned_over(points: FloatArray, done: FloatArray) -> FloatArray:
    """Return a half circle from the first to the last of some points, shape (n, 3), reached as far as is done, (n,)."""
    start, end = points[0], points[-1]
    angles = math.pi * done[:, None]
    on_table = (start + end) / 2.0 + np.cos(angles) * (start - end) / 2.0
    up = np.array([0.0, 0.0, math.dist(start[:2], end[:2]) / 2.0])
    return np.asarray(on_table + np.sin(angles) * up)


def _along(grip: GripMotion, times_s: FloatArray, points: FloatArray) -> GripMotion:
    turned_rad = tuple(grip.turned_at(t_s) for t_s in times_s.tolist()) if grip.turned_rad else ()
    return replace(grip.along(points), times_s=tuple(times_s.tolist()), turned_rad=turned_rad)
