"""A plan for one garment adapted to another that differs a little: the same primitives, checked and made real anew.

While a garment is being drawn each plan is for a drawing that differs from the one before by a vertex. What was the
quickest then mostly can still be done, and mostly is still the quickest; to find out takes one step for each primitive
instead of a search. So it can be shown at once, and the search may take its time.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice, zip_longest

from planner.motion.act import Act
from planner.motion.tries import QUICK
from planner.planning.effort import Effort
from planner.planning.found_plan import FoundPlan
from planner.planning.problem import Problem
from planner.primitives.primitive import Step
from planner.primitives.state import State

_LOOKS_MAX = 12
"""So many ways to do again what a run of primitives did are looked at."""

_BEGUN = 4
"""Of so many ways to begin one way to go on each is looked at before others."""

_PATIENT = replace(QUICK, alone=2 * QUICK.alone, together=2 * QUICK.together, late=1)
"""Twice as many as elsewhere are tried: one that does saves a search."""


def adapted(plan: FoundPlan, problem: Problem, effort: Effort) -> tuple[Act, ...]:
    """What a solved plan does, done in another problem as far as that can be; it may be all of it.

    What is looked at is added to an effort.
    """
    state = problem.start
    acts: list[Act] = []
    for act in plan.acts:
        found = None if problem.is_goal(state) else _act(act, problem, state, effort)
        if found is None:
            break
        acts.append(found)
        state = found.steps[-1].after
    return tuple(acts)


def _act(act: Act, problem: Problem, state: State, effort: Effort) -> Act | None:
    ways = islice(_again(act.steps, problem, state, effort), _LOOKS_MAX)
    likest = next(ways, None)
    if likest is None or act.run is None:
        return None if likest is None else Act(act.first, likest, None)
    maker = problem.maker
    with effort.on_joints():
        run = maker.made_like(maker.candidate(likest), act.run) or maker.first_real(ways, _PATIENT)
    return None if run is None else Act(act.first, run.steps, run)


def _again(steps: Sequence[Step], problem: Problem, state: State, effort: Effort) -> Iterator[tuple[Step, ...]]:
    """The same steps one after the other from a state, the likest first; hands hold on where they did.

    There is time to try only a few, so they are taken in turns from a few that begin in the likest ways: mostly it is
    where they begin that one is real and another is not.
    """
    if not steps:
        yield ()
        return
    effort.expanded += 1
    begun: list[Iterator[tuple[Step, ...]]] = []
    for step in steps[0].again(problem.context, state):
        effort.explored += 1
        if not _may_begin(step, steps, problem):
            continue
        ways = _begun_with(step, steps[1:], problem, effort)
        yield from islice(ways, 1)
        begun.append(ways)
        if len(begun) == _BEGUN:
            yield from _in_turns(begun)
            begun.clear()
    yield from _in_turns(begun)


def _in_turns(begun: Sequence[Iterator[tuple[Step, ...]]]) -> Iterator[tuple[Step, ...]]:
    return (way for turn in zip_longest(*begun) for way in turn if way is not None)


def _may_begin(step: Step, steps: Sequence[Step], problem: Problem) -> bool:
    """Whether steps may begin with one like the first of them; what can follow it takes long to find out."""
    is_alike = bool(step.after.held) == bool(steps[0].after.held)
    return is_alike and (len(steps) == 1 or problem.maker.can_begin_and_end((step,)))


def _begun_with(step: Step, others: Sequence[Step], problem: Problem, effort: Effort) -> Iterator[tuple[Step, ...]]:
    for rest in _again(others, problem, step.after, effort):
        yield (step, *rest)
