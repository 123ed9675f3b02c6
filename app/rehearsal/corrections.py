"""Change the motions of a step to fit the cloth as it lies: moved with it, or taken at another point of it."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from app.rehearsal.vision.look_at_stack import Sight
from app.rehearsal.world import GripMotion, StepMotion, way_done
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2, Point3, Pose2
from planner.task.plan_step import PlanStep

_TRIED = ((1 / 3, 0), (1 / 3, 1), (1 / 3, -1), (2 / 3, 0), (1, 0), (1, 1), (1, -1), (1, 4))
"""How far from the grip, as a share of the radius, and at how many eighths of a turn from inwards it is tried.

Near to it at first: most fingers that miss have closed just beside an edge, and what is beyond the fingers crumples.
"""

SHORT_M = 0.008
"""How far short of its place an edge is laid down where the same hands lift it again (m).

Cloth turns over in a loop, so that the edge below ends inside of its place too, and the upper one would hang down
before it.
"""


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


def reflection_in(step: PlanStep, sequence: FoldSequence, carried: Isometry) -> Isometry | None:
    """Return what a step's fold does to the cloth as it lies, table frame; None if it makes none."""
    if step.fold is None:
        return None
    lies = step.before.placement
    to_table = carried.after(Isometry.rotation(lies.yaw_rad, lies.x_m, lies.y_m))
    over = Isometry.reflection(sequence.folds[step.fold].line)
    return to_table.after(over).after(to_table.inverse)


def regrasps(
    motion: StepMotion,
    arms: frozenset[str],
    radius_m: float,
    inwards: Mapping[str, Point2],
    offsets: Mapping[str, Point2],
    fold: Isometry | None,
) -> Iterator[StepMotion]:
    """Yield the step with some hands at other points round those where they missed, first further into the cloth.

    Args:
        motion: the step.
        arms: the arms that found no cloth.
        radius_m: how far from there, and from their grips, at most (m): within the comfort radius all is in reach.
        inwards: for some arms the direction into the cloth, table frame; the others' is that of their way.
        offsets: how far beside its grip each hand took the cloth at first (m).
        fold: the reflection of the cloth by the step's fold, table frame; None if it makes none.
    """
    for share, eighths in _TRIED:
        tried = {
            grip.arm: _within(
                radius_m,
                offsets.get(grip.arm, (0.0, 0.0)),
                _round(inwards.get(grip.arm) or _way(grip), share * radius_m, math.pi / 4.0 * eighths),
            )
            for grip in motion.grips
            if grip.arm in arms
        }
        yield beside(motion, {**offsets, **tried}, fold)


def beside(motion: StepMotion, offsets: Mapping[str, Point2], fold: Isometry | None) -> StepMotion:
    """Return the step with hands that hold the cloth beside their grips; they land where the fold brings its points.

    Args:
        motion: the step.
        offsets: for some arms, how far beside its grip each begins (m).
        fold: the reflection of the cloth by the step's fold, table frame; None if it makes none.
    """

    def moved(grip: GripMotion) -> GripMotion:
        offset = offsets[grip.arm]
        points = np.array(grip.points)
        share = way_done(points)[:, None]
        landed = offset if fold is None else _turned(fold, offset)
        points[:, :2] += (1.0 - share) * np.array(offset) + share * np.array(landed)
        return _along(grip, points)

    return replace(motion, grips=tuple(moved(grip) if grip.arm in offsets else grip for grip in motion.grips))


def landing_short(motion: StepMotion, arms: frozenset[str], short_m: float) -> StepMotion:
    """Return a fold in which some hands land short of where they should, from the apex on (m)."""

    def moved(grip: GripMotion) -> GripMotion:
        points = np.array(grip.points)
        way = points[0, :2] - points[-1, :2]
        late = np.clip(2.0 * way_done(points) - 1.0, 0.0, 1.0)[:, None]
        points[:, :2] += short_m * late * way / max(float(np.hypot(*way)), short_m)
        return _along(grip, points)

    return replace(motion, grips=tuple(moved(grip) if grip.arm in arms else grip for grip in motion.grips))


def aimed(motion: StepMotion, hands: Mapping[str, Point2]) -> StepMotion:
    """Return the step for hands that are beside where the robot believes them to be, so that they go where they should.

    A hand that closes is as far off all the way; of one that holds on it is only known how far off it begins.

    Args:
        motion: the step.
        hands: how far beside, for some arms, table frame (m).
    """

    def moved(grip: GripMotion) -> GripMotion:
        points = np.array(grip.points)
        share = np.ones(len(points)) if grip.closes else 1.0 - way_done(points)
        points[:, :2] -= share[:, None] * np.array(hands[grip.arm])
        return _along(grip, points)

    return replace(motion, grips=tuple(moved(grip) if grip.arm in hands else grip for grip in motion.grips))


def still_beside(planned: StepMotion, made: StepMotion) -> dict[str, Point2]:
    """Return how far beside their planned ends the hands hold cloth after a step, for those that hold on (m)."""
    pairs = zip(planned.grips, made.grips, strict=True)
    return {one.arm: _from(one.points[-1], other.points[-1]) for one, other in pairs if not one.opens}


def seen_after_drag(motion: StepMotion, ought: Pose2, sight: Sight | None, radius_m: float) -> Isometry:
    """Return how far from where it should be a stack was seen after a drag by hands that hold on, table frame.

    What was seen is not believed where a grip would be further than a radius from the hand that holds it.

    Args:
        motion: the step as planned.
        ought: where the stack should lie after it.
        sight: what was seen; None for nothing.
        radius_m: that radius (m).
    """
    if sight is None or sight.fit is None or not sight.is_estimate:
        return Isometry()
    carried = carry(ought, sight.fit.placement)
    apart_m = [math.hypot(*offset) for offset in held_beside(motion, {}, carried).values()]
    return carried if max(apart_m, default=0.0) <= radius_m else Isometry()


def held_beside(motion: StepMotion, offsets: Mapping[str, Point2], carried: Isometry) -> dict[str, Point2]:
    """Return how far beside the grips of the cloth as it lies hands are that hold on after a step (m).

    Args:
        motion: the step as planned.
        offsets: for some arms, how far beside the planned end of its motion each has ended (m).
        carried: from where the cloth should lie then to where it lies, table frame.
    """

    def offset(grip: GripMotion) -> Point2:
        (x, y), (dx, dy) = grip.points[-1][:2], offsets.get(grip.arm, (0.0, 0.0))
        lies_x, lies_y = carried.apply_point((x, y))
        return x + dx - lies_x, y + dy - lies_y

    return {grip.arm: offset(grip) for grip in motion.grips if not grip.opens}


def _from(start: Point3, end: Point3) -> Point2:
    return end[0] - start[0], end[1] - start[1]


def _way(grip: GripMotion) -> Point2:
    """Return the direction in which a hand goes at first."""
    return _from(grip.points[0], grip.points[len(grip.points) // 2])


def _round(inwards: Point2, radius_m: float, turn_rad: float) -> Point2:
    """Return a point round a grip, from it (m); at a turn of 0 it is the one inwards."""
    angle = math.atan2(inwards[1], inwards[0]) + turn_rad
    return radius_m * math.cos(angle), radius_m * math.sin(angle)


def _within(radius_m: float, first: Point2, second: Point2) -> Point2:
    """Return the sum of two vectors, no longer than a radius (m)."""
    x, y = first[0] + second[0], first[1] + second[1]
    share = min(1.0, radius_m / max(math.hypot(x, y), radius_m))
    return share * x, share * y


def _turned(isometry: Isometry, vector: Point2) -> Point2:
    (x, y), (x0, y0) = isometry.apply_point(vector), isometry.apply_point((0.0, 0.0))
    return x - x0, y - y0


def _along(grip: GripMotion, points: FloatArray) -> GripMotion:
    return replace(grip, points=tuple((x, y, z) for x, y, z in points.tolist()))
