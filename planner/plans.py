"""From a garment and its folds to the quickest sequence of primitives that the robot can perform.

The algorithm of the paper (section 5), from top to bottom:

1. Replay the folds once in the user's order; that makes them legal and yields the Fold-DAG.
2. Search with A* over states (folds done, placement, base, what is held). Its edges are primitives: any fold that
   the DAG makes available, drags towards the robot, moves between stations.
3. The path found is made real: joint paths for both arms, free of collision. Where that fails, or takes longer, the
   search goes on with what is known now.
4. What is real is the plan. If the states run out first, no plan exists, and the obstacles met say why. To know
   that sooner, a search that takes longer looks at each fold alone, everything else relaxed: mostly one is to blame.
"""

from collections.abc import Callable, Sequence
from typing import Unpack

from planner.cloth.garment import Garment
from planner.explain.explanation import Explanation
from planner.planning.budget import Budget
from planner.planning.found_plan import FoundPlan
from planner.planning.plan_search import PlanSearch
from planner.planning.problem import Problem
from planner.planning.quick_plan import quickly_planned
from planner.planning.warm_up import compile_kernels
from planner.task.plan import Plan
from planner.task.scene import Scene
from planner.task.task import Task, TaskOptions


def make_plan(
    what: Task | Garment,
    scene: Scene | None = None,
    *,
    should_stop: Callable[[], bool] | None = None,
    **options: Unpack[TaskOptions],
) -> Plan:
    """Plan how a robot folds a garment in the least time.

    Args:
        what: the task; or a garment, whose task is then made of the other arguments.
        scene: with a garment, the scene; None for the default one.
        should_stop: asked while searching; true ends the search as out of budget.
        options: with a garment, what `Task.of` takes.

    Returns:
        The plan; that none exists, or none was found within the limits, is an answer too. Where time runs out it may be
        one found greedily: `is_proven` says whether nothing is quicker.

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: an option is out of range.
    """
    task = what if isinstance(what, Task) else Task.of(what, scene, **options)
    return find_plan(task, should_stop=should_stop).plan


def find_plan(
    task: Task,
    *,
    should_stop: Callable[[], bool] | None = None,
    known: FoundPlan | None = None,
    like: Sequence[FoundPlan] = (),
    on_found: Callable[[FoundPlan], None] | None = None,
    with_reasons: bool = True,
) -> FoundPlan:
    """Plan as `make_plan` does, with what is known from other plans, and keep what the plan was found with.

    Args:
        task: what is to be planned.
        should_stop: asked while searching; true ends the search as out of budget.
        known: a solved plan for the same, as `quick_plan` gives; the answer is that unless a quicker one is found.
        like: solved plans for garments like it, of use if the search takes long.
        on_found: told, in a search that takes long, of a plan as `quick_plan` gives; the search for the quickest then
            goes on. Where there is no plan, told so with the reasons that were met, while these are tried.
        with_reasons: whether it is of interest why there is no plan, if there is none: that takes more plans.

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: the task's start is none that its folds allow, or there is no such robot.
    """
    compile_kernels()
    problem, limits = Problem.of(task), task.limits
    budget = Budget.of(limits.work_limit_s, limits.time_limit_s, should_stop)
    explainer = Explanation() if with_reasons else None
    if not problem.may_let_go:
        return PlanSearch(
            problem, limits.heuristic, budget, limits.max_expanded, known, like, on_found, explainer
        ).plan()
    found = PlanSearch(problem, limits.heuristic, budget, limits.max_expanded, known, like, on_found).plan()
    free = PlanSearch(problem.let_go(), limits.heuristic, budget, limits.max_expanded, explainer=explainer)
    return found.or_quicker(free.plan())


def quick_plan(
    task: Task, *, like: Sequence[FoundPlan], should_stop: Callable[[], bool] | None = None
) -> FoundPlan | None:
    """Find some plan soon, for a garment that differs a little from others that have plans.

    Args:
        task: what is to be planned.
        like: solved plans for garments like it. The first that can still be done is done, the same primitives one
            after the other; where none can, what of one can, and the rest is found by a search that is greedy.
        should_stop: asked again and again; true ends it without a plan.

    Returns:
        A plan that the robot can perform, joint paths included; a quicker one may exist (`bound_s` is what the folds
        alone take). None where none was found soon, which says nothing about whether there is one.

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: the task's start is none that its folds allow, or there is no such robot.
    """
    compile_kernels()
    return quickly_planned(Problem.of(task), like, should_stop or (lambda: False))
