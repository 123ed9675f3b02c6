"""A plan for one garment adapted to another that differs a little: the same primitives, checked and made real anew.

While a garment is being drawn each plan is for a drawing that differs from the one before by a vertex. What was the
quickest then mostly can still be done, and mostly is still the quickest; to find out takes one step for each primitive
instead of a search. So it can be shown at once, and the search may take its time.
"""

import time
from collections.abc import Iterator, Sequence
from itertools import islice

from planner.plan.act import Act
from planner.plan.heuristic import arm_time
from planner.plan.plan import Plan, Statistics
from planner.plan.problem import Problem
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.primitives.work import Work

_TRIES = 12
"""So many ways to do again what a run of primitives did are tried."""


def adapted(plan: Plan, problem: Problem) -> Plan | None:
    """What a solved plan does, done in another problem; None where that cannot be."""
    started = time.perf_counter()
    work, state = problem.work, problem.start
    acts: list[Act] = []
    for act in plan.acts if work.unrest(0, state.offset) is None else ():
        found = _act(act, problem, state)
        if found is None:
            return None
        acts.append(found)
        state = found.steps[-1].after
    if not acts or state.done != (1 << len(work.sequence.folds)) - 1:
        return None
    took_s, bound_s = time.perf_counter() - started, arm_time(work)(problem.start)
    statistics = Statistics(0, 0, work.reach.queries, work.reach.query_time_s, took_s, 0.0, bound_s)
    work.forget()
    return Plan.of(problem, plan.status, tuple(acts), (), statistics)


def _act(act: Act, problem: Problem, state: State) -> Act | None:
    for steps in islice(_again(act.steps, problem.work, state), _TRIES):
        if act.run is None:
            return Act(act.first, steps, None)
        run = problem.maker.made(steps, like=act.run)
        if run is not None:
            return Act(act.first, run.steps, run)
    return None


def _again(steps: Sequence[Step], work: Work, state: State) -> Iterator[tuple[Step, ...]]:
    """The same steps one after the other from a state, the likest first; hands hold on where they did.

    There is time to try only a few, so they are mixed: those that begin in the likest way, more and more of others.
    """
    if not steps:
        yield ()
        return
    begins = (step for step in steps[0].again(work, state) if bool(step.after.held) == bool(steps[0].after.held))
    begun: list[Iterator[tuple[Step, ...]]] = []
    while True:
        begun += [_begun_with(step, steps[1:], work) for step in islice(begins, 1)]
        if not begun:
            return
        for ways in tuple(begun):
            way = next(ways, None)
            if way is None:
                begun.remove(ways)
            else:
                yield way


def _begun_with(step: Step, others: Sequence[Step], work: Work) -> Iterator[tuple[Step, ...]]:
    for rest in _again(others, work, step.after):
        yield (step, *rest)
