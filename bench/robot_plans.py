"""Plans of the nine garments for every other shipped robot: what comes of them, their costs, and the CPU time.

Tables are smaller than the PR2's, so each garment is shrunk until its longest side fits the robot's. Where there is no
plan at the place that the robot's card suggests, another is looked for as a suggestion would. Each plan is made once:
the joint paths that it finds stay in memory. Then corners are moved, as `bench.re_plan` does.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from statistics import median
from time import process_time

from app.drawing.garment_drawing import drawing_of
from bench.measurement import TIME_LIMIT_S
from bench.paper import TABLE_2
from bench.re_plan import ILLEGAL, redrawn
from bench.report import ABSENT, Report, Row, seconds
from planner import Garment, Task, load_garment, make_plan
from planner.explain.suggestion import Suggestion, SuggestionTrial, TrialBudget
from planner.explain.suggestion_placement import placements
from planner.planning.budget import Budget
from planner.planning.problem import forget_garments
from planner.planning.robot_task import task_for
from planner.planning.warm_up import compile_kernels
from planner.robots.known_robots import shipped_robots
from planner.robots.load_robot import load_robot
from planner.task.task import DEFAULT_ROBOT

COLUMNS = (
    "robot, garment",
    "status",
    "why not",
    "cost [s]",
    "CPU [s]",
    "laid elsewhere",
    "CPU [s]",
    "edit [ms]",
    "most",
)

LONGEST_M = 0.95
"""Longest side of a garment (m)."""

LONGEST_OF_M = {"so101-pair": 0.35}
"""The same for robots whose arms are short."""

EDITS = 3
"""Corners of a garment that are moved."""

PLACES_WORK_S, PLACES_TIME_S, PLACE_WORK_S = 120.0, 900.0, 4.0
"""The work and the time for looking for another place, and the most work of the plan at one (s)."""


@dataclass(frozen=True, slots=True)
class Measured:
    """A robot's plan of a garment.

    Attributes:
        robot: the robot.
        garment: the garment.
        status: the plan's status where the card has the garment lie.
        why_not: the code of the first reason why there is no plan; None if it is solved.
        cost_s: the plan's duration (s); None unless solved.
        cpu_s: the CPU time of the plan (s).
        place: another place that gives a plan; None if there is none, or none was needed.
        place_cost_s: the duration of the plan there (s).
        place_cpu_s: the CPU time of looking for it (s); None if none was needed.
        edits_ms: the CPU time from each edit to the first plan (ms); none without any plan.
    """

    robot: str
    garment: str
    status: str
    why_not: str | None
    cost_s: float | None
    cpu_s: float
    place: dict[str, float] | None
    place_cost_s: float | None
    place_cpu_s: float | None
    edits_ms: tuple[float, ...]


def robot_plans(garments: Sequence[str], _repetitions: int) -> Report:
    """Measure a plan of each garment for each shipped robot but the default one, its map and its kernels loaded."""
    chosen = [garment for garment in TABLE_2 if garment in garments]
    robots = [name for name in shipped_robots() if name != DEFAULT_ROBOT] if chosen else []
    rows = tuple(_row(one) for robot in robots for one in _measured(robot, chosen))
    title = f"Plans of any robot: garments of {LONGEST_M} m at most, for the SO-101 {LONGEST_OF_M['so101-pair']} m"
    return Report("robot-plans", title, COLUMNS, rows, 1)


def shrunk(garment: Garment, longest_m: float) -> Garment:
    """Return a garment with its folds, shrunk until its longest side has at most a length (m)."""
    sides = [max(side) - min(side) for side in zip(*garment.outline, strict=True)]
    share = min(1.0, longest_m / max(sides))
    data = garment.to_dict()
    data["outline"] = [[share * x, share * y] for x, y in garment.outline]
    for fold in data["folds"]:
        fold |= {end: [share * value for value in fold[end]] for end in ("start", "end")}
    return Garment.from_dict(data)


def _measured(robot: str, garments: Sequence[str]) -> Iterator[Measured]:
    """Yield the measurements of each garment, after an edit that loads what edits need."""
    compile_kernels(robot)
    for garment in garments:
        yield _planned(robot, garment)


def _planned(robot: str, name: str) -> Measured:
    garment = shrunk(load_garment(name), LONGEST_OF_M.get(robot, LONGEST_M))
    task = task_for(garment, robot=robot, time_limit_s=TIME_LIMIT_S)
    forget_garments()
    load_robot(robot).forget_reach()
    started = process_time()
    plan = make_plan(task)
    cpu_s = process_time() - started
    why_not = plan.reasons[0].code.value if plan.reasons else None
    found, place_cpu_s = (None, None) if plan.is_solved else _elsewhere(task)
    is_folded = plan.is_solved or found is not None
    lies = task if found is None else task.at(found.plan.task.start.placement)
    edits_ms = tuple(_edits_ms(garment, lies)) if is_folded else ()
    place = None if found is None else found.plan.task.start.placement.to_dict()
    there_s = None if found is None else found.cost_s
    return Measured(robot, name, plan.status, why_not, plan.cost_s, cpu_s, place, there_s, place_cpu_s, edits_ms)


def _elsewhere(task: Task) -> tuple[Suggestion | None, float]:
    """Return the nearest place that gives a plan, if there is one, and the CPU time that it took to look for it (s)."""
    started = process_time()
    budget, search = TrialBudget(Budget.of(PLACES_WORK_S, PLACES_TIME_S)), placements(task, None)
    wish = next(search, None)
    while isinstance(wish, SuggestionTrial) and not budget.has_spent(1.0):
        try:
            wish = search.send(budget.plan(wish.task, PLACE_WORK_S, by_folds_alone=wish.by_folds_alone))
        except StopIteration:
            break
    return wish if isinstance(wish, Suggestion) else None, process_time() - started


def _edits_ms(garment: Garment, task: Task) -> Iterator[float]:
    """Yield the CPU times to the first plan after each of some edits (ms)."""
    drawing = replace(drawing_of(garment, robot=task.robot), placement=task.start.placement)
    return (1e3 * one.first_cpu_s for one in redrawn(drawing, EDITS) if one.status != ILLEGAL)


def _row(one: Measured) -> Row:
    times = (one.cost_s, one.place_cost_s, one.place_cpu_s)
    cost, there, looked = (ABSENT if time_s is None else seconds(time_s, 1) for time_s in times)
    edits = [f"{pick(one.edits_ms):.0f}" if one.edits_ms else ABSENT for pick in (median, max)]
    name, why_not = f"{one.robot} {one.garment}", one.why_not or ABSENT
    return Row(((name, one.status, why_not, cost, seconds(one.cpu_s, 2), there, looked, *edits),), asdict(one))
