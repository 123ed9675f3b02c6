"""Suggest what would have to be true of the world for a plan to exist: friction, grip radius, comfort radius.

Each is suggested in sensible steps: the least step that gives a plan, tried as it is told. The values that the reasons
found are tried first, otherwise the furthest value. Friction and comfort radius only ever allow more the further they
go. So if the furthest gives no plan, nothing less does; if it does, the least is found by bisection.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from planner.cloth.garment import DrawnFold
from planner.explain.suggestion_trial import Proof, Search, SuggestionTrial
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


@dataclass(frozen=True, slots=True)
class Assumption:
    """An assumption that can be made in steps.

    Attributes:
        now: the number of steps as it is.
        most: the number of steps at most.
        trial_at: makes the trial of a task with so many steps of it.
    """

    now: int
    most: int
    trial_at: Callable[[Task, int], SuggestionTrial]


def comforts(task: Task) -> Search:
    """Look for the largest comfort radius below the requested one that gives a plan."""
    return _least(task, _comforts(task))


def frictions(task: Task, reasons: Sequence[Reason]) -> Search:
    """Look for the smallest friction coefficient above the scene's that gives a plan."""
    needed = [r.needed_friction for r in reasons if r.needed_friction is not None and r.set is not None]
    return _least(task, _frictions(task), [_step_above(mu * FRICTION_STEPS) for mu in needed])


def grip_radii(task: Task, folds: Sequence[int], reasons: Sequence[Reason]) -> Search:
    """Look for the smallest grip radius of some folds that gives a plan."""
    needed = [r.needed_grip_radius_m for r in reasons if r.needed_grip_radius_m is not None]
    first = [_step_above(radius * GRIP_RADIUS_STEPS_PER_M) for radius in needed]
    return _least(task, _grip_radii(task, folds), first)


def assumptions(task: Task, folds: Sequence[int]) -> tuple[Assumption, ...]:
    """Return all assumptions that can be made for a task; `folds`: those whose grips may hold more."""
    return _comforts(task), _frictions(task), _grip_radii(task, folds)


def _comforts(task: Task) -> Assumption:
    now = task.limits.comfort_radius_m
    steps = math.ceil(now / COMFORT_STEP_M - LENGTH_M)
    return Assumption(0, steps, lambda task, step: _comfort(task, max(round(now - step * COMFORT_STEP_M, 6), 0.0)))


def _frictions(task: Task) -> Assumption:
    now, most = _step_below(task.scene.friction * FRICTION_STEPS), round(FRICTION_MAX * FRICTION_STEPS)
    return Assumption(now, most, lambda task, step: _friction(task, step / FRICTION_STEPS))


def _grip_radii(task: Task, folds: Sequence[int]) -> Assumption:
    smallest = min((task.garment.folds[i].grip_radius_m for i in folds), default=GRIP_RADIUS_MAX_M)
    now, most = _step_below(smallest * GRIP_RADIUS_STEPS_PER_M), round(GRIP_RADIUS_MAX_M * GRIP_RADIUS_STEPS_PER_M)
    return Assumption(now, most, lambda task, step: _grip_radius(task, folds, step / GRIP_RADIUS_STEPS_PER_M))


def _step_above(steps: float) -> int:
    """Round up to a whole step."""
    return math.ceil(steps - LENGTH_M)


def _step_below(steps: float) -> int:
    """Round down to a whole step."""
    return math.floor(steps + LENGTH_M)


def _least(task: Task, assumption: Assumption, first: Sequence[int] = ()) -> Search:
    """Look for the fewest steps that work, beyond those that fail; try some steps first, then the most."""
    fails, most = assumption.now, assumption.most
    best: Proof | None = None
    works, is_known = most + 1, False
    for step in sorted({step for step in (*first, most) if fails < step <= most}):
        best = Proof.of(trial := assumption.trial_at(task, step), (yield trial))
        if best is not None:
            works, is_known = step, step in first
            break
        fails = step
    while works - fails > 1 and best is not None:
        middle, is_known = works - 1 if is_known else (fails + works) // 2, False
        trial = assumption.trial_at(task, middle)
        plan = yield trial
        if plan is None:
            break
        proof = Proof.of(trial, plan)
        fails, works, best = (middle, works, best) if proof is None else (fails, middle, proof)
    if best is not None:
        yield best.suggestion


def _comfort(task: Task, radius_m: float) -> SuggestionTrial:
    says = worded("assume_comfort", {"comfort_m": radius_m, "now_m": task.limits.comfort_radius_m})
    size = task.limits.comfort_radius_m - radius_m
    return SuggestionTrial("comfort_radius", says, {"comfort_radius_m": radius_m}, size, task.within(radius_m))


def _friction(task: Task, friction: float) -> SuggestionTrial:
    scene = replace(task.scene, friction=friction)
    says = worded("assume_friction", {"friction": friction, "now": task.scene.friction})
    size = friction - task.scene.friction
    return SuggestionTrial("friction", says, {"scene": scene.to_dict()}, size, task.in_scene(scene))


def _grip_radius(task: Task, folds: Sequence[int], radius_m: float) -> SuggestionTrial:
    def widened(index: int, fold: DrawnFold) -> DrawnFold:
        return replace(fold, grip_radius_m=max(radius_m, fold.grip_radius_m)) if index in folds else fold

    drawn = task.garment.folds
    in_drags_m = max(radius_m, task.garment.grip_radius_m)
    folds_now = tuple(widened(i, fold) for i, fold in enumerate(drawn))
    garment = replace(task.garment, folds=folds_now, grip_radius_m=in_drags_m)
    says = worded("assume_grip_radius", {"grip_radius_m": radius_m, "folds": list(folds)}, drawn)
    size = radius_m - min(drawn[i].grip_radius_m for i in folds)
    return SuggestionTrial("grip_radius", says, {"garment": garment.to_dict()}, size, replace(task, garment=garment))
