"""Plans of the nine articles for every other shipped robot: what comes of them, their costs, and the CPU time.

Tables are smaller than the PR2's, so each article is shrunk until its longest side fits the robot's. Each plan is made
once: the joint paths that it finds stay in memory.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from time import process_time

from bench.measurement import TIME_LIMIT_S
from bench.paper import TABLE_2
from bench.report import ABSENT, Report, Row, seconds
from planner import Garment, load_garment, make_plan
from planner.planning.problem import forget_garments
from planner.planning.warm_up import compile_kernels
from planner.robots.described_robot import shipped_robots
from planner.robots.load_robot import load_robot
from planner.task.task import DEFAULT_ROBOT

COLUMNS = ("robot, article", "status", "cost [s]", "CPU [s]")

LONGEST_M = 0.95
"""Longest side of an article (m)."""

LONGEST_OF_M = {"so101-pair": 0.35}
"""The same for robots whose arms are short."""


@dataclass(frozen=True, slots=True)
class Measured:
    """A robot's plan of an article: its status, its duration (s; None unless solved) and the CPU time it took (s)."""

    robot: str
    article: str
    status: str
    cost_s: float | None
    cpu_s: float


def robot_plans(articles: Sequence[str], _repetitions: int) -> Report:
    """Measure a plan of each article for each shipped robot but the default one, its map and its kernels loaded."""
    chosen = [article for article in TABLE_2 if article in articles]
    robots = [name for name in shipped_robots() if name != DEFAULT_ROBOT] if chosen else []
    rows = tuple(_row(one) for robot in robots for one in _measured(robot, chosen))
    title = f"Plans of any robot: articles of {LONGEST_M} m at most, for the SO-101 {LONGEST_OF_M['so101-pair']} m"
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


def _measured(robot: str, articles: Sequence[str]) -> list[Measured]:
    compile_kernels(robot)
    return [_planned(robot, article) for article in articles]


def _planned(robot: str, article: str) -> Measured:
    garment = shrunk(load_garment(article), LONGEST_OF_M.get(robot, LONGEST_M))
    forget_garments()
    load_robot(robot).forget_reach()
    started = process_time()
    plan = make_plan(garment, robot=robot, time_limit_s=TIME_LIMIT_S)
    cpu_s = process_time() - started
    return Measured(robot, article, plan.status, plan.cost_s if plan.is_solved else None, cpu_s)


def _row(one: Measured) -> Row:
    cost = ABSENT if one.cost_s is None else seconds(one.cost_s, 1)
    return Row(((f"{one.robot} {one.article}", one.status, cost, seconds(one.cpu_s, 2)),), asdict(one))
