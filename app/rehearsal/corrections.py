"""Change the motions of a step to fit the cloth as it lies: moved with it, or taken at another point of it."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from app.rehearsal.world import GripMotion, StepMotion, way_done
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2, Pose2

REGRASPS = 8
"""Points round a grip at which a grasp that missed is tried again (paper, section 9)."""


def carry(start: Pose2, end: Pose2) -> Isometry:
    """Return the isometry that carries an article from one placement to another, table frame."""
    to, back = (Isometry.rotation(pose.yaw_rad, pose.x_m, pose.y_m) for pose in (end, start))
    return to.after(back.inverse)


def shift_of(motion: StepMotion, carried: Isometry) -> float:
    """Return how far the furthest grip of a step is from where the cloth has it now (m)."""
    picks = [grip.points[0][:2] for grip in motion.grips]
    return max((math.dist(pick, carried.apply_point(pick)) for pick in picks), default=0.0)


def corrected(motion: StepMotion, carried: Isometry) -> StepMotion:
    """Return a step made for cloth that lies elsewhere: a fold is carried along, a drag ends where it should."""

    def carried_along(points: FloatArray) -> FloatArray:
        moved = np.column_stack([carried.apply(points[:, :2]), points[:, 2]])
        if not motion.is_drag:
            return moved
        left = 1.0 - way_done(points)[:, None]
        return np.asarray(points + left * (moved[0] - points[0]))

    return replace(motion, grips=tuple(_along(grip, carried_along(np.array(grip.points))) for grip in motion.grips))


def regrasps(motion: StepMotion, arms: frozenset[str], radius_m: float, fold: Isometry | None) -> Iterator[StepMotion]:
    """Yield the step with some hands at other points round their grips, first at those further into the cloth.

    Args:
        motion: the step.
        arms: the arms that found no cloth.
        radius_m: how far from their grips (m): within the comfort radius everything is in reach.
        fold: the reflection of the cloth by the step's fold, table frame; None if it makes none.
    """
    for number in range(REGRASPS):
        turn = math.pi / 4.0 * ((number + 1) // 2) * (-1.0 if number % 2 else 1.0)
        yield replace(
            motion,
            grips=tuple(_beside(grip, radius_m, turn, fold) if grip.arm in arms else grip for grip in motion.grips),
        )


def _beside(grip: GripMotion, radius_m: float, turn_rad: float, fold: Isometry | None) -> GripMotion:
    """Return a grip's motion for a point of the cloth beside it; it lands where the fold brings that point."""
    points = np.array(grip.points)
    ahead = points[len(points) // 2, :2] - points[0, :2]
    angle = math.atan2(ahead[1], ahead[0]) + turn_rad
    offset = radius_m * np.array([math.cos(angle), math.sin(angle)])
    landed = offset if fold is None else np.array(_turned(fold, (float(offset[0]), float(offset[1]))))
    share = way_done(points)[:, None]
    points[:, :2] += (1.0 - share) * offset + share * landed
    return _along(grip, points)


def _turned(isometry: Isometry, vector: Point2) -> Point2:
    (x, y), (x0, y0) = isometry.apply_point(vector), isometry.apply_point((0.0, 0.0))
    return x - x0, y - y0


def _along(grip: GripMotion, points: FloatArray) -> GripMotion:
    return replace(grip, points=tuple((x, y, z) for x, y, z in points.tolist()))
