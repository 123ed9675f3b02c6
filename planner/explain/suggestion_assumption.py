"""Suggest what would have to be true of the world for a plan to exist: friction, grip radius, comfort radius.

Each is suggested in sensible steps: the least step that gives a plan, tried as worded. The values that the reasons
found are tried first, otherwise the furthest value. Friction and comfort radius only ever allow more the further they
go. So if the furthest gives no plan, nothing less does; if it does, the least is found by bisection.

Where none of them alone gives a plan, all are assumed to the utmost. If that gives one, those that are not needed are
dropped, and of each that is left the least is found while the others stay.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeAlias

from planner.explain.change import COMFORT, FRICTION, Change, SpentError, grip_radius
from planner.explain.suggestion import Search, SuggestionTrial, proven, smallest
from planner.geometry.tolerance import LENGTH_M
from planner.task.reason import Reason
from planner.task.scene import FRICTION_MAX
from planner.task.task import Task
from planner.words.catalogue import worded

FRICTION_STEPS = 100
"""Steps in a friction coefficient of 1."""

GRIP_RADIUS_STEPS_PER_M, GRIP_RADIUS_MAX_M = 1000, 0.5
"""Steps in a metre, and the largest grip radius that is tried (m)."""

COMFORT_STEPS_PER_M = 1000
"""Steps in a metre of the comfort radius."""

_Steps: TypeAlias = Mapping[int, int]
"""How far each assumption goes, by its index."""


@dataclass(frozen=True, slots=True)
class _Assumption:
    """An assumption that can be made in steps.

    Attributes:
        change: the change.
        now: the number of steps as it is.
        most: the number of steps at most.
        amount_at: turns a number of steps into the amount of the change.
    """

    change: Change
    now: int
    most: int
    amount_at: Callable[[float], float]

    def least(self, task: Task, first: Sequence[int] = ()) -> Search:
        """Look for the fewest steps that work, beyond those that fail; try some steps first, then the most."""

        def trial_at(step: float) -> SuggestionTrial | None:
            return SuggestionTrial.of(self.change, task, self.amount_at(step))

        fails = self.now
        for step in sorted({step for step in (*first, self.most) if self.now < step <= self.most}):
            proof = yield from proven(trial_at(step))
            if proof is not None:
                _, least = yield from smallest(trial_at, fails, step, proof, 1, is_near=step in first)
                yield least
                return
            fails = step


def comforts(task: Task) -> Search:
    """Look for the largest comfort radius below the requested one that gives a plan."""
    return _comfort(task).least(task)


def frictions(task: Task, reasons: Sequence[Reason]) -> Search:
    """Look for the smallest friction coefficient above the scene's that gives a plan."""
    needed = [r.needed_friction for r in reasons if r.needed_friction is not None and r.set is not None]
    return _friction(task).least(task, [_step_above(mu * FRICTION_STEPS) for mu in needed])


def grip_radii(task: Task, folds: Sequence[int], reasons: Sequence[Reason]) -> Search:
    """Look for the smallest grip radius of some folds that gives a plan."""
    needed = [r.needed_grip_radius_m for r in reasons if r.needed_grip_radius_m is not None]
    return _grip_radius(task, folds).least(task, [_step_above(radius * GRIP_RADIUS_STEPS_PER_M) for radius in needed])


def together(task: Task, folds: Sequence[int]) -> Search:
    """Look for the fewest assumptions, two at least, that give a plan, and the least of each.

    Args:
        task: the task.
        folds: the indices of the folds whose grips may hold more.
    """
    assumptions = (_comfort(task), _friction(task), _grip_radius(task, folds))
    steps: _Steps = {n: one.most for n, one in enumerate(assumptions) if one.most > one.now}
    best = yield from proven(_assumed(task, assumptions, steps))
    if best is None:
        return
    with suppress(SpentError):
        for number in tuple(steps):
            rest = {other: step for other, step in steps.items() if other != number}
            proof = (yield from proven(_assumed(task, assumptions, rest))) if rest else None
            if proof is not None:
                steps, best = rest, proof
    if len(steps) < 2:
        return  # one alone is suggested by itself
    for number, most in tuple(steps.items()):

        def trial_at(step: float, others: _Steps = steps, number: int = number) -> SuggestionTrial | None:
            return _assumed(task, assumptions, {**others, number: round(step)})

        works, best = yield from smallest(trial_at, assumptions[number].now, most, best, 1)
        steps = {**steps, number: round(works)}
    yield best


def _assumed(task: Task, assumptions: Sequence[_Assumption], steps: _Steps) -> SuggestionTrial | None:
    """Return the trial of several assumptions at once; None where one of them gives no valid task."""
    changed, parts, size = task, [], 0.0
    for number, step in steps.items():
        one = assumptions[number]
        part = SuggestionTrial.of(one.change, changed, one.amount_at(step))
        if part is None:
            return None
        changed = part.task
        parts.append(part.says.to_dict())
        size += (step - one.now) / (one.most - one.now)
    says = worded("assume_together", {"parts": parts}, task.garment.folds)
    return SuggestionTrial("together", says, size, task, changed)


def _comfort(task: Task) -> _Assumption:
    now_m = task.limits.comfort_radius_m
    most = _step_above(now_m * COMFORT_STEPS_PER_M)
    return _Assumption(COMFORT, 0, most, lambda step: min(step / COMFORT_STEPS_PER_M, now_m))


def _friction(task: Task) -> _Assumption:
    now, steps = task.scene.friction, FRICTION_STEPS
    most = round(FRICTION_MAX * steps)
    return _Assumption(FRICTION, _step_below(now * steps), most, lambda step: step / steps - now)


def _grip_radius(task: Task, folds: Sequence[int]) -> _Assumption:
    steps, most = GRIP_RADIUS_STEPS_PER_M, round(GRIP_RADIUS_MAX_M * GRIP_RADIUS_STEPS_PER_M)
    now_m = min((task.garment.folds[fold].grip_radius_m for fold in folds), default=GRIP_RADIUS_MAX_M)
    change = grip_radius(folds, in_drags=True)
    return _Assumption(change, _step_below(now_m * steps), most, lambda step: step / steps - now_m)


def _step_above(steps: float) -> int:
    """Round up to a whole step."""
    return math.ceil(steps - LENGTH_M)


def _step_below(steps: float) -> int:
    """Round down to a whole step."""
    return math.floor(steps + LENGTH_M)
