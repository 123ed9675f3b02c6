"""Relaxations of how hands hold what a fold needs: wider grips, hands closer together, stiffer cloth, a third hand."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from planner.explain.reason_grips import needed_radius
from planner.explain.relaxation import Relaxation
from planner.explain.relaxed_problem import RelaxedProblem
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.task.reason import Code, Reason
from planner.task.scene import SUPPORT_ANGLE_MAX_RAD
from planner.words.catalogue import worded

_THIRD_HAND_CORNERS_MAX = 12
"""Corners of the cloth above which the ways for three hands to hold it are too many."""


def hand_relaxations(context: Context, reason: Reason, fold: int) -> Iterator[Relaxation]:
    """Yield wider grips in the fold alone or in drags too, hands closer together, stiffer cloth, a third hand."""
    if reason.needed_grip_radius_m is None:
        yield _blue(fold)
        return
    drawn, needed = context.sequence.folds[fold], reason.needed_grip_radius_m
    by_m, one_hands_m = needed - drawn.grip_radius_m, _one_hands_radius(context, fold) - drawn.grip_radius_m
    yield _grip_radius(context, fold, (by_m,), needed, in_drags=False)
    yield _grip_radius(context, fold, tuple(sorted({by_m, max(one_hands_m, by_m)})), needed, in_drags=True)
    if reason.code is Code.GRIPS_TOO_CLOSE and reason.short_by_m is not None:
        apart_m = context.grips_apart_m
        yield Relaxation("apart", (reason.short_by_m,), lambda relaxed, by: relaxed.with_grips_nearer(apart_m - by))
    if reason.code is Code.TOO_MANY_GRIPS:
        yield _stiffer(context, fold)
        if len(context.sequence.garment.outline) <= _THIRD_HAND_CORNERS_MAX:
            yield _third_hand(context, fold)


def _grip_radius(
    context: Context, fold: int, amounts: tuple[float, ...], needed: float, *, in_drags: bool
) -> Relaxation:
    now = context.sequence.folds[fold].grip_radius_m

    def applied(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        garment = relaxed.context.sequence.garment
        wider = replace(garment.folds[fold], grip_radius_m=now + amount)
        folds = (*garment.folds[:fold], wider, *garment.folds[fold + 1 :])
        of_drags = max(garment.grip_radius_m, now + amount) if in_drags else garment.grip_radius_m
        return relaxed.with_garment(replace(garment, folds=folds, grip_radius_m=of_drags))

    def told(reason: Reason, amount: float) -> Reason:
        if abs(now + amount - needed) <= LENGTH_M and not in_drags:
            return reason
        values = {"grip_radius_m": now, "needed_grip_radius_m": now + amount, "in_drags": in_drags}
        says = worded("wider_grip", values, context.sequence.folds, fold)
        return replace(reason, says=says, short_by_m=amount, needed_grip_radius_m=now + amount)

    return Relaxation("grip_radius", amounts, applied, told)


def _stiffer(context: Context, fold: int) -> Relaxation:
    """Return the relaxation to stiffer cloth, of which more holds itself."""
    now = context.scene.support_angle_rad

    def applied(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        angle = min(now + amount, SUPPORT_ANGLE_MAX_RAD)
        return relaxed.with_scene(replace(relaxed.context.scene, support_angle_rad=angle))

    def told(reason: Reason, amount: float) -> Reason:
        values = {"support_angle_rad": now, "needed_support_angle_rad": now + amount}
        says = worded("stiffer_cloth", values, context.sequence.folds, fold)
        return replace(reason, says=says, short_by_m=None, needed_grip_radius_m=None)

    return Relaxation("support_angle", (SUPPORT_ANGLE_MAX_RAD - now,), applied, told, exact=math.radians(0.5))


def _third_hand(context: Context, fold: int) -> Relaxation:
    hands = len(context.reach.arm_names)

    def told(reason: Reason, _: float) -> Reason:
        says = worded("one_more_hand", {"hands": hands}, context.sequence.folds, fold)
        return replace(reason, says=says, needed_grip_radius_m=None)

    return Relaxation("hands", (), lambda relaxed, _: relaxed.with_more_hands(1), told, is_hypothetical=True)


def _one_hands_radius(context: Context, fold: int) -> float:
    """Return the grip radius with which one hand would hold all that a fold needs (m)."""
    drawn, arms = context.sequence.folds[fold], len(context.reach.arm_names)
    vertices = np.array(context.sequence.covers(fold, context.scene.support_angle_rad, arms).vertices)
    return needed_radius(context.sequence.moving(fold), drawn.line, vertices, 1) if len(vertices) else 0.0


def _blue(fold: int) -> Relaxation:
    def applied(relaxed: RelaxedProblem, _: float) -> RelaxedProblem:
        garment = relaxed.context.sequence.garment
        blue = replace(garment.folds[fold], kind="blue")
        return relaxed.with_garment(replace(garment, folds=(*garment.folds[:fold], blue, *garment.folds[fold + 1 :])))

    return Relaxation("blue", (), applied)
