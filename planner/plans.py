"""Plan the quickest sequence of primitives with which the robot folds a garment.

The algorithm of the paper (section 5), from top to bottom:

1. Replay the folds once in the user's order. This checks that they are legal and yields the Fold-DAG.
2. Search with A* over states (folds done, placement, base, what is held). The edges are primitives: any fold that the
   DAG makes available, drags towards the robot, moves between stations.
3. Validate the path found: look for joint paths of both arms that are free of collision. Where there are none, or they
   take longer than assumed, the search continues with the costs known by then.
4. Hands hold firmly wherever they can: every vertex within 8 cm of a grip. Only where that gives no plan with half of
   the work allowed is all of this done again with grips that hold within the garment's own radius.
5. A validated path is the plan. If the search exhausts all states first, no plan exists, and the obstacles that it met
   say why. To find this out sooner, a search that takes long also checks each fold alone with everything else relaxed:
   usually a single fold is to blame.
"""

import math
from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace
from typing import Unpack

from planner.cloth.garment import Garment
from planner.deadline import ShouldStop
from planner.errors import RequestError
from planner.explain.explanation import explained
from planner.planning.budget import Budget
from planner.planning.events import Blocked, Done, Event, Improved
from planner.planning.found_plan import FoundPlan
from planner.planning.plan_search import Hints, quickest
from planner.planning.problem import Problem
from planner.planning.quick_plan import quickly_planned
from planner.planning.robot_task import task_for
from planner.planning.warm_up import compile_kernels
from planner.task.plan import Plan
from planner.task.reason import Reason
from planner.task.scene import Scene
from planner.task.task import Task, TaskOptions

FIRM_SHARE = 0.5
"""The share of all work and time that is spent on hands that hold firmly, where no plan is found."""


def make_plan(
    what: Task | Garment,
    scene: Scene | None = None,
    *,
    should_stop: ShouldStop | None = None,
    **options: Unpack[TaskOptions],
) -> Plan:
    """Plan how a robot folds a garment in the least time.

    Args:
        what: the task, or a garment; the task for a garment is made from the other arguments.
        scene: the scene for a garment; None for the one that suits the robot.
        should_stop: polled during the search; the search ends as out of budget when it returns true.
        options: the options of `Task.of`, for a garment.

    Returns:
        The plan. Its status may also say that no plan exists, or that none was found within the limits. Where time runs
        out, the plan may come from a greedy search: `is_proven` says whether nothing is quicker.

    Raises:
        FoldError: a fold is not legal on the cloth as the folds before it leave it.
        RequestError: an option is unknown or out of range, or neither a task nor a garment was given.
    """
    if not isinstance(what, Task | Garment):
        raise RequestError(
            "garment",
            f"expected Task or Garment, got {type(what).__name__}; `load_garment` returns one by name or file",
        )
    task = what if isinstance(what, Task) else task_for(what, scene, **options)
    return find_plan(task, should_stop=should_stop).plan


def plan(
    task: Task,
    hints: Hints | None = None,
    *,
    should_stop: ShouldStop | None = None,
    with_reasons: bool = True,
    improving_s: float = math.inf,
) -> Generator[Event, None, None]:
    """Plan a task as `make_plan` does, and tell what is found on the way.

    Nothing is searched ahead of what is taken: who has enough takes no more, and closes the stream.

    Args:
        task: the task to plan.
        hints: plans to start from; None for none.
        should_stop: polled between events; the search ends as out of budget when it returns true.
        with_reasons: whether to find out why there is no plan, if there is none; this takes further planning.
        improving_s: the work after which no quicker plan is looked for, once there is one (s).

    Yields:
        Plans found meanwhile, each quicker than the one before; where there is no plan, the reasons that the search
        met, before they are tried; at last the answer.

    Raises:
        FoldError: a fold is not legal on the cloth as the folds before it leave it.
        RequestError: the folds do not allow the task's start, or the robot is unknown.
    """
    compile_kernels(task.robot)
    budget = Budget.of(task.limits.work_limit_s, task.limits.time_limit_s, should_stop)
    part = Budget.of(FIRM_SHARE * budget.work_limit_s, FIRM_SHARE * task.limits.time_limit_s, should_stop)
    try:
        for event in _firmly_or_not(task, part, budget, hints or Hints(), with_reasons=with_reasons):
            if event.found.plan.is_solved:
                part.narrow(improving_s)
                budget.narrow(improving_s)
            yield event
    finally:
        for one in (part, budget):
            one.deadline.forget()  # the plan keeps its context, which has it


def _firmly_or_not(task: Task, part: Budget, budget: Budget, hints: Hints, *, with_reasons: bool) -> Iterator[Event]:
    """Plan a task for hands that hold firmly; where there is no such plan, for hands that hold in any way.

    A plan that has to beat a cost is looked for with firm hands only: whether there is a dearer one is not known then.
    Once a firm plan is found, quicker ones are looked for with all of the budget, until then with a part of it.
    """
    is_known_firm = hints.known is not None and hints.known.context.is_firm
    firm = Problem.of(task, part.deadline).firm()
    for event in _planned(firm, part, hints if is_known_firm else replace(hints, known=None)):
        if event.found.plan.is_solved:
            part.widen(budget)
            yield event
    if event.found.plan.is_solved:
        return
    if hints.are_bounding:
        yield event
        return
    budget.beside_s += part.spent_s
    # This problem knows where the arms reach as far as has been queried.
    events = _planned(Problem.of(task, budget.deadline), budget, hints)
    yield from _explained(events) if with_reasons else events


def _planned(problem: Problem, budget: Budget, hints: Hints) -> Iterator[Event]:
    """Plan a problem, with drags by the arms and hands that let go where these help."""
    if problem.context.is_fixed and hints.known is None and not problem.may_let_go:
        # Drags by the arms cost two motions and save none: where folds alone give a plan, drags are not looked for.
        if (yield from _solved(quickest(problem.without_arm_drags(), budget, hints))):
            return
        problem = problem.anew()
    if not problem.may_let_go:
        yield from quickest(problem, budget, hints)
        return
    for event in quickest(problem, budget, hints):
        held = event.found
        if isinstance(event, Improved):
            yield event
    for event in quickest(problem.let_go(), budget, Hints(below_s=hints.below_s)):
        if isinstance(event, Done):
            yield Done(held.or_quicker(event.found))
        elif isinstance(event, Blocked) and not held.plan.is_solved:
            yield event


def _solved(events: Iterator[Event]) -> Generator[Event, None, bool]:
    """Yield the plans that a search finds, and return whether it ends with one."""
    for event in events:
        if event.found.plan.is_solved:
            yield event
    return event.found.plan.is_solved


def _explained(events: Iterator[Event]) -> Iterator[Event]:
    """Add to a search's events the reasons why there is no plan: those met at once, and those that prove true."""
    reasons: tuple[Reason, ...] = ()
    for event in events:
        if isinstance(event, Blocked):
            found = explained(event.obstacles)
            yield replace(event, found=event.found.with_reasons(next(found)))
            (reasons,) = found
        elif isinstance(event, Done) and event.found.plan.status == "infeasible":
            yield Done(event.found.with_reasons(reasons))
        else:
            yield event


def find_plan(
    task: Task,
    *,
    should_stop: ShouldStop | None = None,
    known: FoundPlan | None = None,
    like: Sequence[FoundPlan] = (),
    with_reasons: bool = True,
) -> FoundPlan:
    """Return the answer that ends the stream of `plan`, with the data that it was found with; see there.

    A plan that is known, as `quick_plan` returns it, is the answer unless a quicker one is found; those for similar
    garments are used as a fallback if the search takes long.
    """
    *_, end = plan(task, Hints(known, like), should_stop=should_stop, with_reasons=with_reasons)
    return end.found


def quick_plan(task: Task, *, like: Sequence[FoundPlan], should_stop: ShouldStop | None = None) -> FoundPlan | None:
    """Find some plan soon, for a garment that differs a little from garments that have plans.

    Args:
        task: the task to plan.
        like: solved plans for similar garments. The first plan whose primitives can all be done again is used. Where
            there is none, the plan of which most can be done again is used as far as possible, and a greedy search
            finds the rest.
        should_stop: polled repeatedly; planning ends without a plan when it returns true.

    Returns:
        A plan that the robot can perform, joint paths included; a quicker one may exist (`bound_s` is the time for the
        folds alone). None where no plan was found soon, which does not prove that there is none.

    Raises:
        FoldError: a fold is not legal on the cloth as the folds before it leave it.
        RequestError: the folds do not allow the task's start, or the robot is unknown.
    """
    compile_kernels(task.robot)
    problem, budget = Problem.of(task), Budget.endless(should_stop)
    return quickly_planned(problem.firm(), like, budget) or quickly_planned(problem, like, budget)
