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

import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

from planner.cloth.garment import Garment
from planner.errors import RequestError
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Pose2
from planner.plan.act import Act
from planner.plan.alone import Alone
from planner.plan.heuristic import HEURISTICS
from planner.plan.machine import Machine
from planner.plan.plan import Plan, PlannedPrimitive, Statistics
from planner.plan.real_run import RunMaker
from planner.plan.realizer import Realizer
from planner.plan.reason import Reason
from planner.plan.reasons import note_collision, reason_at_start, reasons
from planner.plan.warm_up import warm_up
from planner.primitives.obstacle import situation
from planner.primitives.primitive import Later, Step, in_time
from planner.primitives.primitive_set import PRIMITIVES
from planner.primitives.scene import Scene
from planner.primitives.state import State
from planner.primitives.work import Work
from planner.robot.pr2 import load_robot
from planner.search.a_star import Edge, Outcome, Promise, SearchResult, Successors, a_star

COMFORT_MAX_M = 0.1
TIME_LIMIT_S = (0.01, 60.0)
EXPANDED_MAX = 1_000_000
LOOK_ALONE_AFTER = 30
"""Most plans are found within so many expansions; after them each fold not done yet is looked at alone."""

_COLLISIONS_MAX = 12
"""Of so many motions that the arms could not follow it is looked at what was in their way."""


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
    max_expanded: int = 100_000,
    should_stop: Callable[[], bool] | None = None,
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
        max_expanded: its budget in states (1..1,000,000).
        should_stop: asked while searching; true ends the search as out of budget.

    Returns:
        The plan; that none exists, or none was found within the budget, is an answer too.

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: an option is out of range.
    """
    scene = scene or Scene()
    _require_options(scene, start_station, comfort_radius_m, heuristic, time_limit_s, max_expanded)
    compile_kernels()
    problem = _problem(garment, scene, placement, robot, comfort_radius_m)
    station = [name for name, _ in scene.stations].index(start_station)
    return _Planner(*problem, heuristic, time_limit_s, max_expanded, should_stop).plan(station)


def compile_kernels() -> None:
    """Compile what is compiled, or load it from the cache, once a process; `make_plan` sees to it too."""
    warm_up(_plan_simply)


def _plan_simply(garment: Garment) -> Plan:
    problem = _problem(garment, Scene(), None, "pr2", 0.0)
    return _Planner(*problem, "arm_time", TIME_LIMIT_S[1], EXPANDED_MAX, None).plan(0)


def _problem(
    garment: Garment, scene: Scene, placement: Pose2 | None, robot: str, comfort_radius_m: float
) -> tuple[Work, Machine]:
    machine = load_robot(robot)
    reach = machine.reach(scene.torso_m, comfort_radius_m)
    sequence = FoldSequence.of(garment)
    return Work(sequence, scene, reach, placement or garment.placement, machine.card.base_radius_m), machine


class _Planner:
    """One search: its budget, and what it met on the way."""

    def __init__(
        self,
        work: Work,
        robot: Machine,
        heuristic: str,
        time_limit_s: float,
        max_expanded: int,
        should_stop: Callable[[], bool] | None,
    ) -> None:
        self._work = work
        self._robot = robot
        self._heuristic = HEURISTICS[heuristic](work)
        self._max_expanded = max_expanded
        self._started = time.perf_counter()
        self._deadline = self._started + time_limit_s
        self._should_stop = should_stop or (lambda: False)
        self._primitives = [kind(work) for kind in PRIMITIVES]
        self._achieved = 0
        self._reached: set[State] = set()
        self._expanded = 0
        self._station = 0
        self._blocking: list[int] = []
        self._maker = RunMaker(work, robot)
        self._realizer = Realizer(self._maker)
        self._steps: dict[State, tuple[Step | Later[Step], ...]] = {}
        self._worked_out: dict[Later[Step], tuple[Step | Later[Step], ...]] = {}
        self._explored = 0
        self._joint_time_s = 0.0
        self._is_looked_at_alone = False

    def plan(self, station: int) -> Plan:
        self._station = station
        start = State(0, (0.0, 0.0), station, 0)
        unrest = self._work.unrest(0, start.offset)
        if unrest is not None:
            nothing: SearchResult[State, Step] = SearchResult(Outcome.INFEASIBLE, (), 0.0, 0.0, 0, 0)
            return self._answer(start, nothing, (), (reason_at_start(self._work, unrest),))
        result, acts = self._real_path(start)
        if self._blocking:
            result = replace(result, outcome=Outcome.INFEASIBLE)
        is_proof = result.outcome is Outcome.INFEASIBLE
        return self._answer(start, result, acts, self._reasons() if is_proof else ())

    def _real_path(self, start: State) -> tuple[SearchResult[State, Step], tuple[Act, ...]]:
        """The quickest path that is real, and what it is then."""
        while True:
            result = a_star(start, self._successors, self._is_goal, self._heuristic, self._max_expanded, self._is_over)
            self._explored += result.explored
            if result.outcome is not Outcome.SOLVED:
                return result, ()
            begun = time.perf_counter()
            found = self._realizer.acts([edge.action for edge in result.path])
            self._joint_time_s += time.perf_counter() - begun
            if found is not None:
                return result, found
            self._achieved = 0
            self._reached.clear()

    def _reasons(self) -> tuple[Reason, ...]:
        for run in self._realizer.struck[-_COLLISIONS_MAX:]:
            note_collision(self._work, run[-1], self._maker.snag(run))
        return reasons(self._work, {situation(state) for state in self._reached}, self._blocking)

    def _successors(self, state: State) -> Successors[State, Step]:
        if state not in self._steps:
            self._expanded += 1
            self._steps[state] = tuple(one for kind in self._primitives for one in in_time(kind.successors(state)))
        return self._edges(state, self._steps[state])

    def _edges(self, state: State, found: Iterable[Step | Later[Step]]) -> Successors[State, Step]:
        """The edges of steps that may be real, and promises of those that have time."""
        for later in (one for one in found if isinstance(one, Later)):
            yield Promise(later.duration_s, later.towards, partial(self._redeemed, state, later))
        for step, cost_s in self._realizer.possible(state, (one for one in found if not isinstance(one, Later))):
            self._achieved |= step.after.done
            self._reached.add(step.after)
            yield Edge(step, cost_s, step.after)

    def _redeemed(self, state: State, later: Later[Step]) -> Successors[State, Step]:
        if later not in self._worked_out:
            self._worked_out[later] = tuple(later.steps())
        return self._edges(state, self._worked_out[later])

    def _is_goal(self, state: State) -> bool:
        return state.done == (1 << len(self._work.sequence.folds)) - 1

    def _is_over(self) -> bool:
        if self._expanded >= LOOK_ALONE_AFTER and not self._is_looked_at_alone:
            self._is_looked_at_alone = True
            alone = Alone(self._work, self._station, self._is_out_of_budget)
            self._blocking = [fold for fold in self._next_unseen() if alone.is_impossible(fold)]
        return bool(self._blocking) or self._is_out_of_budget()

    def _is_out_of_budget(self) -> bool:
        return time.perf_counter() > self._deadline or self._should_stop()

    def _next_unseen(self) -> list[int]:
        """The folds that no state has done yet though nothing is left that they wait for."""
        available = self._work.sequence.dag.available(self._achieved)
        return [fold for fold in available if not self._achieved >> fold & 1]

    def _answer(
        self,
        start: State,
        result: SearchResult[State, Step],
        acts: tuple[Act, ...],
        why: tuple[Reason, ...],
    ) -> Plan:
        is_solved = result.outcome is Outcome.SOLVED
        primitives, end_s = self._schedule(acts)
        last = result.path[-1].after.offset if result.path else (0.0, 0.0)
        bound = {Outcome.SOLVED: end_s, Outcome.INFEASIBLE: None}.get(result.outcome, result.bound)
        reach = self._work.reach
        elapsed = time.perf_counter() - self._started - self._joint_time_s
        statistics = Statistics(
            self._expanded, self._explored, reach.queries, reach.query_time_s, elapsed, self._joint_time_s, bound
        )
        self._work.forget()
        return Plan(
            result.outcome.value,
            primitives,
            end_s if is_solved else None,
            self._work.placed(last) if is_solved else None,
            why,
            statistics,
            self._work,
            self._robot,
            start,
            acts,
            self._maker,
        )

    def _schedule(self, acts: tuple[Act, ...]) -> tuple[tuple[PlannedPrimitive, ...], float]:
        planned, now = [], 0.0
        for act in acts:
            for step, duration_s in zip(act.steps, act.durations_s(), strict=True):
                planned.append(PlannedPrimitive(step, now, duration_s, self._work.base_stop(step.after)))
                now += duration_s
        return tuple(planned), now


def _require_options(
    scene: Scene,
    start_station: str,
    comfort_radius_m: float,
    heuristic: str,
    time_limit_s: float,
    max_expanded: int,
) -> None:
    names = [name for name, _ in scene.stations]
    if start_station not in names:
        raise RequestError("start_station", f"{start_station!r} is none of {', '.join(names)}")
    if heuristic not in HEURISTICS:
        raise RequestError("heuristic", f"{heuristic!r} is none of {', '.join(HEURISTICS)}")
    _require_between("comfort_radius_m", comfort_radius_m, 0.0, COMFORT_MAX_M)
    _require_between("time_limit_s", time_limit_s, *TIME_LIMIT_S)
    _require_between("max_expanded", max_expanded, 1, EXPANDED_MAX)


def _require_between(field: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise RequestError(field, f"{value} is not between {low:g} and {high:g}")
