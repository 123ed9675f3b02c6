"""Suggest what would have to be true of the world for a plan to exist: friction, grip radius, comfort radius.

Each is suggested in sensible steps: the least step that gives a plan, tried as it is told. The values that the reasons
found are tried first, otherwise the furthest value. Friction and comfort radius only ever allow more the further they
go. So if the furthest gives no plan, nothing less does; if it does, the least is found by bisection.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from planner.cloth.garment import DrawnFold
from planner.explain.suggestion_trial import Proof, Search, Trial
from planner.geometry.tolerance import LENGTH_M
from planner.task.reason import Reason
from planner.task.scene import FRICTION_MAX
from planner.task.task import Task
from planner.words.catalogue import worded

FRICTION_STEPS = 100
"""Steps in a friction coefficient of 1."""

GRIP_RADIUS_STEPS_PER_M, GRIP_RADIUS_MAX_M = 1000, 0.5
"""Steps in a metre, and the largest grip radius that is tried (m)."""

COMFORT_STEP_M = 0.001
"""Step between comfort radii (m)."""


def comforts(task: Task) -> Search:
    """Look for the largest comfort radius below the requested one that gives a plan."""
    now = task.limits.comfort_radius_m
    steps = math.ceil(now / COMFORT_STEP_M - LENGTH_M)
    return _least(lambda step: _comfort(task, max(round(now - step * COMFORT_STEP_M, 6), 0.0)), 0, steps)


def frictions(task: Task, reasons: Sequence[Reason]) -> Search:
    """Look for the smallest friction coefficient above the scene's that gives a plan."""
    now = _step_below(task.scene.friction * FRICTION_STEPS)
    needed = [r.needed_friction for r in reasons if r.needed_friction is not None and r.set is not None]
    first = [_step_above(mu * FRICTION_STEPS) for mu in needed]
    most = round(FRICTION_MAX * FRICTION_STEPS)
    return _least(lambda step: _friction(task, step / FRICTION_STEPS), now, most, first)


def grip_radii(task: Task, folds: Sequence[int], reasons: Sequence[Reason]) -> Search:
    """Look for the smallest grip radius of some folds that gives a plan."""
    smallest = min((task.garment.folds[i].grip_radius_m for i in folds), default=GRIP_RADIUS_MAX_M)
    needed = [r.needed_grip_radius_m for r in reasons if r.needed_grip_radius_m is not None]
    first = [_step_above(radius * GRIP_RADIUS_STEPS_PER_M) for radius in needed]
    now, most = _step_below(smallest * GRIP_RADIUS_STEPS_PER_M), round(GRIP_RADIUS_MAX_M * GRIP_RADIUS_STEPS_PER_M)
    return _least(lambda step: _grip_radius(task, folds, step / GRIP_RADIUS_STEPS_PER_M), now, most, first)


def _step_above(steps: float) -> int:
    """Round up to a whole step."""
    return math.ceil(steps - LENGTH_M)


def _step_below(steps: float) -> int:
    """Round down to a whole step."""
    return math.floor(steps + LENGTH_M)


def _least(trial_at: Callable[[int], Trial], fails: int, most: int, first: Sequence[int] = ()) -> Search:
    """Look for the fewest steps that work, beyond some that fail; try some steps first, then the most."""
    best: Proof | None = None
    works, is_known = most + 1, False
    for step in sorted({step for step in (*first, most) if fails < step <= most}):
        best = Proof.of(trial := trial_at(step), (yield trial))
        if best is not None:
            works, is_known = step, step in first
            break
        fails = step
    while works - fails > 1 and best is not None:
        middle, is_known = works - 1 if is_known else (fails + works) // 2, False
        trial = trial_at(middle)
        plan = yield trial
        if plan is None:
            break
        proof = Proof.of(trial, plan)
        fails, works, best = (middle, works, best) if proof is None else (fails, middle, proof)
    if best is not None:
        yield best.suggestion


def _comfort(task: Task, radius_m: float) -> Trial:
    says = worded("assume_comfort", {"comfort_m": radius_m, "now_m": task.limits.comfort_radius_m})
    size = task.limits.comfort_radius_m - radius_m
    return Trial("comfort_radius", says, {"comfort_radius_m": radius_m}, size, task.within(radius_m))


def _friction(task: Task, friction: float) -> Trial:
    scene = replace(task.scene, friction=friction)
    says = worded("assume_friction", {"friction": friction, "now": task.scene.friction})
    size = friction - task.scene.friction
    return Trial("friction", says, {"scene": scene.to_dict()}, size, task.in_scene(scene))


def _grip_radius(task: Task, folds: Sequence[int], radius_m: float) -> Trial:
    def widened(index: int, fold: DrawnFold) -> DrawnFold:
        return replace(fold, grip_radius_m=max(radius_m, fold.grip_radius_m)) if index in folds else fold

    drawn = task.garment.folds
    in_drags_m = max(radius_m, task.garment.grip_radius_m)
    folds_now = tuple(widened(i, fold) for i, fold in enumerate(drawn))
    garment = replace(task.garment, folds=folds_now, grip_radius_m=in_drags_m)
    says = worded("assume_grip_radius", {"grip_radius_m": radius_m, "folds": list(folds)}, drawn)
    size = radius_m - min(drawn[i].grip_radius_m for i in folds)
    return Trial("grip_radius", says, {"garment": garment.to_dict()}, size, replace(task, garment=garment))
