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

import math
from collections.abc import Callable, Sequence

from planner.cloth.garment import Garment
from planner.errors import RequestError
from planner.geometry.pose import Pose2
from planner.plan.budget import Budget
from planner.plan.heuristic import HEURISTICS
from planner.plan.plan import Plan
from planner.plan.plan_search import PlanSearch
from planner.plan.problem import Problem, require_between
from planner.plan.quick_plan import quickly_planned
from planner.plan.warm_up import warm_up
from planner.task.scene import Scene

TIME_LIMIT_S = (0.01, 60.0)
EXPANDED_MAX = 1_000_000


def make_plan(
    garment: Garment,
    scene: Scene | None = None,
    *,
    placement: Pose2 | None = None,
    start_station: str = "front",
    robot: str = "pr2",
    comfort_radius_m: float = 0.03,
    heuristic: str = "arm_time",
    time_limit_s: float = 10.0,
    work_limit_s: float | None = None,
    max_expanded: int = 100_000,
    should_stop: Callable[[], bool] | None = None,
    known: Plan | None = None,
    like: Sequence[Plan] = (),
    on_found: Callable[[Plan], None] | None = None,
    with_reasons: bool = True,
) -> Plan:
    """Plan how a robot folds a garment in the least time.

    Args:
        garment: the garment, its folds in the user's order.
        scene: table, stations and costs; None for the default scene.
        placement: the article frame in the table frame at the start; None for the garment's own.
        start_station: where the robot stands at the start.
        robot: the robot's name.
        comfort_radius_m: a point counts as reachable only if a circle of this radius round it is (m, 0..0.1).
        heuristic: "arm_time" or "zero".
        time_limit_s: the budget of the search (s, 0.01..60).
        work_limit_s: its budget in work, in seconds of a machine of our day; None for as much as the time limit. Where
            it ends the search, and not the time, the same request has the same answer on every machine.
        max_expanded: its budget in states (1..1,000,000).
        should_stop: asked while searching; true ends the search as out of budget.
        known: a solved plan for the same, as `quick_plan` gives; the answer is that unless a quicker one is found.
        like: solved plans for garments like it, of use if the search takes long.
        on_found: told, in a search that takes long, of a plan as `quick_plan` gives; the search for the quickest then
            goes on.
        with_reasons: whether it is of interest why there is no plan, if there is none: that takes more plans.

    Returns:
        The plan; that none exists, or none was found within the budget, is an answer too. Where time runs out it may be
        one found greedily: `is_proven` says whether nothing is quicker.

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: an option is out of range.
    """
    require_between("time_limit_s", time_limit_s, *TIME_LIMIT_S)
    require_between("max_expanded", max_expanded, 1, EXPANDED_MAX)
    if heuristic not in HEURISTICS:
        raise RequestError("heuristic", f"{heuristic!r} is none of {', '.join(HEURISTICS)}")
    compile_kernels()
    problem = Problem.of(garment, scene or Scene(), placement, start_station, robot, comfort_radius_m)
    budget = Budget.of(work_limit_s, time_limit_s, should_stop)
    search = PlanSearch(problem, heuristic, budget, max_expanded, known, like, on_found)
    return search.plan(with_reasons=with_reasons)


def quick_plan(
    garment: Garment,
    scene: Scene | None = None,
    *,
    like: Sequence[Plan],
    placement: Pose2 | None = None,
    start_station: str = "front",
    robot: str = "pr2",
    comfort_radius_m: float = 0.03,
    should_stop: Callable[[], bool] | None = None,
) -> Plan | None:
    """Find some plan soon, for a garment that differs a little from others that have plans.

    Args:
        garment: the garment, its folds in the user's order.
        scene: table, stations and costs; None for the default scene.
        like: solved plans for garments like it. The first that can still be done is done, the same primitives one
            after the other; where none can, what of one can, and the rest is found by a search that is greedy.
        placement: the article frame in the table frame at the start; None for the garment's own.
        start_station: where the robot stands at the start.
        robot: the robot's name.
        comfort_radius_m: a point counts as reachable only if a circle of this radius round it is (m, 0..0.1).
        should_stop: asked again and again; true ends it without a plan.

    Returns:
        A plan that the robot can perform, joint paths included; a quicker one may exist (`statistics.bound_s` is what
        the folds alone take). None where none was found soon, which says nothing about whether there is one.

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: an option is out of range.
    """
    compile_kernels()
    problem = Problem.of(garment, scene or Scene(), placement, start_station, robot, comfort_radius_m)
    return quickly_planned(problem, like, should_stop or (lambda: False))


def compile_kernels() -> None:
    """Compile what is compiled, or load it from the cache, once a process; `make_plan` sees to it too.

    What is there by then, modules above all, the garbage collector does not look at any more (`gc.freeze`).
    """
    warm_up(_plan_simply)


def _plan_simply(garment: Garment) -> Plan:
    problem = Problem.of(garment, Scene(), None, "front", "pr2", 0.0)
    return PlanSearch(problem, "arm_time", Budget.of(math.inf, math.inf), EXPANDED_MAX).plan()
