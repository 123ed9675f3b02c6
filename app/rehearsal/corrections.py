"""Correct a step's motion for the cloth as it was seen: a list of corrections, each applied to the result of the last.

A correction takes a motion and the step as it was seen, and returns the motion, unchanged where it does not apply.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce

import numpy as np

from app.rehearsal.grasp_points import inwards_at
from app.rehearsal.judge import carry
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.trailing_flaps import trailing
from app.rehearsal.vision.look_at_stack import Sight
from app.rehearsal.world import GripMotion, StepMotion, way_done
from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2, Point3, Pose2
from planner.geometry.table import TableTop
from planner.geometry.tolerance import LENGTH_M

_TRIED = ((1 / 3, 0), (1 / 3, 1), (1 / 3, -1), (2 / 3, 0), (1, 0), (1, 1), (1, -1), (1, 4))
"""How far from the grip, as a share of the radius, and at how many eighths of a turn from inwards it is tried.

Near to it at first: most fingers that miss have closed just beside an edge, and what is beyond the fingers crumples.
"""

SHORT_M = 0.008
"""How far short of its place an edge is laid down where the same hands lift it again (m).

Cloth turns over in a loop, so that the edge below ends inside of its place too, and the upper one would hang down
before it.
"""


Correction = Callable[[StepMotion, StepSeen], StepMotion]


def corrected(seen: StepSeen, corrections: Sequence[Correction]) -> StepMotion:
    """Return the motion of a step with corrections applied in order."""
    return reduce(lambda motion, correction: correction(motion, seen), corrections, seen.motion)


def carried_along(motion: StepMotion, seen: StepSeen) -> StepMotion:
    """Move a step to where the cloth lies: all of a fold, and the start of a drag, which ends as planned."""

    def moved(grip: GripMotion) -> GripMotion:
        points = np.array(grip.points)
        there = np.column_stack([seen.carried.apply(points[:, :2]), points[:, 2]])
        if motion.is_drag:
            there = points + (1.0 - way_done(points)[:, None]) * (there[0] - points[0])
        return grip.along(there)

    return motion.with_grips(moved)


_TAUT_SHARE = 0.5
"""How far hands go from their planned paths to those of a stiff sheet, at most."""

_POINTS = 61
"""How many points a path has once it has left the planned one."""


def taut(motion: StepMotion, most_m: float) -> StepMotion:
    """Return a fold whose hands keep the cloth between them and the fold line taut; other steps unchanged.

    On a plan's path a hand halfway down is nearer to the fold line than its cloth is long, by .29 of it, and two hands
    at different distances from the line come nearer to each other. Cloth bends in loops and does not lie down behind
    them: the slack stands up, draws the crease inside of its line, and springs back when it is let go. A flap that
    turned about the line as a stiff sheet would have no slack, but a long one hangs through and would pull at the
    stack. So hands go half of the way from the one to the other, as far as that is in reach.

    The fold begins and ends as planned. Hands that hold cloth before or after it, and those that do not cross a line,
    keep their paths.

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
    share = min(_TAUT_SHARE, max(0.0, most_m) / max(furthest_m, LENGTH_M))
    grips = zip(motion.grips, planned, beside, strict=True)
    return replace(
        motion, grips=tuple(_along(grip, times_s, points + share * offsets) for grip, points, offsets in grips)
    )


def _crossed_m(grip: GripMotion) -> float:
    """Return how far a hand goes over the table from its first point to its last (m)."""
    return math.dist(grip.points[0][:2], grip.points[-1][:2])


def _turned_over(points: FloatArray, done: FloatArray) -> FloatArray:
    """Return points on the half circle from the first to the last of some points, at shares of it, (n,) -> (n, 3)."""
    start, end = points[0], points[-1]
    angles = math.pi * done[:, None]
    on_table = (start + end) / 2.0 + np.cos(angles) * (start - end) / 2.0
    up = np.array([0.0, 0.0, math.dist(start[:2], end[:2]) / 2.0])
    return np.asarray(on_table + np.sin(angles) * up)


def _along(grip: GripMotion, times_s: FloatArray, points: FloatArray) -> GripMotion:
    turned_rad = tuple(grip.turned_at(t_s) for t_s in times_s.tolist()) if grip.turned_rad else ()
    return replace(grip.along(points), times_s=tuple(times_s.tolist()), turned_rad=turned_rad)


def kept_taut(motion: StepMotion, seen: StepSeen) -> StepMotion:
    """Keep cloth taut while it is folded over (see `taut`), as far as the hands can reach."""
    return taut(motion, seen.spare_m)


def laid_short(motion: StepMotion, seen: StepSeen) -> StepMotion:
    """End short of the planned place, from the apex on, where the same hands lift the cloth again in the next step.

    Beyond the edge below it would hang down and hook on it. A red fold goes on from where the fold before it ended.
    """
    fold = seen.step.fold
    if fold is None or seen.sequence.folds[fold].is_red or not seen.step.details.get("holds"):
        return motion
    held = {one.arm for one in seen.step.holdings}

    def moved(grip: GripMotion) -> GripMotion:
        points = np.array(grip.points)
        way = points[0, :2] - points[-1, :2]
        late = np.clip(2.0 * way_done(points) - 1.0, 0.0, 1.0)[:, None]
        points[:, :2] += SHORT_M * late * way / max(float(np.hypot(*way)), SHORT_M)
        return grip.along(points)

    return motion.with_grips(moved, held)


def beside_grips(motion: StepMotion, seen: StepSeen) -> StepMotion:
    """Shift hands by the offsets at which they take the cloth (`StepSeen.offsets`), mirrored where a fold lands."""

    def moved(grip: GripMotion) -> GripMotion:
        offset = seen.offsets[grip.arm]
        points = np.array(grip.points)
        share = way_done(points)[:, None]
        landed = offset if seen.fold is None else _turned(seen.fold, offset)
        points[:, :2] += (1.0 - share) * np.array(offset) + share * np.array(landed)
        return grip.along(points)

    return motion.with_grips(moved, seen.offsets)


def over_edge(motion: StepMotion, seen: StepSeen) -> StepMotion:
    """End hands that lay cloth over the table's edge as far beyond the edge as the cloth should hang.

    A plan's hand ends as low as the cloth is to hang, and clear of the edge's plane. From the edge to there is further
    than the cloth hangs, which draws it out of the stack by the difference; and a hand that follows cloth sideways
    would still end as low. So hands end as far from the edge as the cloth is to hang, straight out where that is less
    than tools keep clear.
    """
    top, clear_m = TableTop.of(seen.plan.scene.table), seen.plan.scene.edge_clear_m
    planned = {grip.arm: np.array(grip.points[-1]) for grip in seen.planned.grips}

    def moved(grip: GripMotion) -> GripMotion:
        points, end = np.array(grip.points), planned[grip.arm]
        if not grip.opens or top.covers(end[None]):
            return grip
        nearest, outwards, _ = top.edge_beside(end)
        hangs_at = nearest + (REST_HEIGHT_M - end[2]) * outwards  # if the table went on
        late = np.clip(2.0 * way_done(points) - 1.0, 0.0, 1.0)[:, None]
        laid = laid_over(hangs_at + points[-1, :2] - end[:2], top, clear_m)
        return grip.along(points + late * (laid - points[-1]))

    return motion.with_grips(moved) if motion.is_fold else motion


def laid_over(place: FloatArray, top: TableTop, clear_m: float) -> FloatArray:
    """Return where a hand ends to lay cloth at a place beyond the table, shape (2,) -> (3,), m.

    Args:
        place: where the cloth would lie if the table went on.
        top: the table's top.
        clear_m: how far outside of an edge's plane a tool keeps at most (m).
    """
    nearest, outwards, beyond = top.edge_beside(place)
    out_m = min(float(beyond), clear_m)
    return np.array([*(nearest + out_m * outwards), REST_HEIGHT_M - math.sqrt(float(beyond) ** 2 - out_m**2)])


WITHOUT_LOOKING: tuple[Correction, ...] = (over_edge,)
BY_WHAT_IS_SEEN: tuple[Correction, ...] = (carried_along, kept_taut, laid_short, beside_grips, trailing, over_edge)
"""The corrections without and with feedback, in their order."""


def aimed(motion: StepMotion, hands: Mapping[str, Point2]) -> StepMotion:
    """Return the step with the errors of the hands' positions subtracted, so that they go where they should.

    The error of a hand that closes is the same all the way; that of a hand that holds on is known only at its start.

    Args:
        motion: the step.
        hands: where each hand is, relative to where the robot believes it to be, by arm, table frame (m).
    """

    def moved(grip: GripMotion) -> GripMotion:
        points = np.array(grip.points)
        share = np.ones(len(points)) if grip.closes else 1.0 - way_done(points)
        points[:, :2] -= share[:, None] * np.array(hands[grip.arm])
        return grip.along(points)

    return motion.with_grips(moved, hands)


def regrasps(seen: StepSeen, arms: frozenset[str]) -> Iterator[dict[str, Point2]]:
    """Yield the offsets at which hands that missed try again, round where they missed, first further into the cloth.

    All are within the comfort radius of where the hands missed and of their grips, which is in reach.

    Args:
        seen: the step, and where hands took the cloth at first.
        arms: the arms that found no cloth.
    """
    # A drag may pull the cloth behind it, so that its way says nothing of where cloth is; a fold's leads over it.
    ways = {grip.arm: _way(grip) for grip in carried_along(seen.motion, seen).grips}
    inwards = ways | (inwards_at(seen) if seen.fold is None else {})
    for share, eighths in _TRIED:
        round_it = {arm: _round(inwards[arm], share * seen.radius_m, math.pi / 4.0 * eighths) for arm in arms}
        yield {
            **seen.offsets,
            **{arm: _within(seen.radius_m, seen.offsets.get(arm, (0.0, 0.0)), gone) for arm, gone in round_it.items()},
        }


def still_beside(seen: StepSeen, made: StepMotion) -> dict[str, Point2]:
    """Return the offset of each hand that holds on after a step from the end of its carried motion (m)."""
    pairs = zip(carried_along(seen.motion, seen).grips, made.grips, strict=True)
    return {one.arm: _from(one.points[-1], other.points[-1]) for one, other in pairs if not one.opens}


def seen_after_drag(motion: StepMotion, ought: Pose2, sight: Sight | None, radius_m: float) -> Isometry:
    """Return the seen offset of a stack from its planned pose, after a drag by hands that keep holding; table frame.

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
    """Return the offset of each hand that holds on after a step from its grip on the cloth as it lies (m).

    Args:
        motion: the step as planned.
        offsets: for some arms, the offset of the end of the motion from the planned one (m).
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
    """Return the vector over the table from a hand's first point to the middle of its path (m)."""
    return _from(grip.points[0], grip.points[len(grip.points) // 2])


def _round(inwards: Point2, radius_m: float, turn_rad: float) -> Point2:
    """Return a vector of a length (m), turned by an angle (rad) from the direction inwards."""
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
