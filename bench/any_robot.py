"""The reach of every shipped robot: its map, what an answer takes, and what it misses of what random starts find.

The truth is found by two other ways: Newton's method from many random postures, which shares the method's kernel, not
its starts; and random joints, whose tool poses are in reach by themselves and of any approach, not the map's alone.
`tests/robots/test_mapped_arm.py` holds the map against the PR2's closed form, which shares nothing.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from statistics import median
from time import process_time

import numpy as np

from bench.report import Report, Row, count
from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.chain import PITCH, Chain, tool_poses
from planner.robots.described_robot import DescribedArm, read_robot
from planner.robots.known_robots import shipped_robots
from planner.robots.mapped_arm import ALL_ROUND, MappedArm, heights
from planner.robots.newton import solve_from
from planner.robots.reach_maps import build_map, grid_of

COLUMNS = (
    "robot",
    "joints",
    "build [s]",
    "map [MB]",
    "yes [us]",
    "no [us]",
    "reachable",
    "missed",
    "recall",
    "of random joints",
)
POSES, RESTARTS = 3000, 200
POSTURES = 100_000
"""Random joints whose tool poses are asked where they point down over the table."""

STEEP = 0.25
"""The sine of the least pitch that is asked: 14 degrees."""

SEED = 5


@dataclass(frozen=True, slots=True)
class Measured:
    """The measurements of a robot's first arm."""

    robot: str
    joints: int
    build_s: float
    map_mb: float
    yes_us: float
    no_us: float
    reachable: int
    missed: int
    recall: float
    random_recall: float


def any_robot(garments: Sequence[str], repetitions: int) -> Report:
    """Measure the first arm of each shipped robot; the garments do not matter."""
    rows = tuple(_row(_measured(name, repetitions)) for name in shipped_robots())
    title = (
        f"Reach of any robot: {POSES} poses over the table, {len(ALL_ROUND)} approaches, truth by {RESTARTS} restarts"
    )
    return Report("any-robot", title, COLUMNS, rows, repetitions)


def _measured(name: str, repetitions: int) -> Measured:
    robot = read_robot(name)
    described = robot.arms[0]
    chain = described.chain
    grid = grid_of(chain, ALL_ROUND, heights(robot, described))
    build_map(chain, grid._replace(counts=np.ones(3, dtype=np.int64)))  # so that compiling is not measured
    started = process_time()
    arm = MappedArm(described, build_map(chain, grid))
    build_s = process_time() - started
    rng = np.random.default_rng(SEED)
    points = rng.uniform(grid.low, grid.low + grid.counts * grid.cell, (POSES, 3)) + described.root
    rotations = grid.rotations[rng.integers(0, len(grid.rotations), POSES)]
    found = arm.can_reach(points, rotations)
    true = found | _by_restarts(chain, points - described.root, rotations, ~found, rng)
    yes_us, no_us = (_time_us(arm, points[asked], rotations[asked], repetitions) for asked in (found, ~found))
    missed = int(true.sum() - found.sum())
    recall = float(found.sum() / true.sum())
    of_random = _random_recall(arm, described, heights(robot, described), rng)
    counts = (int(true.sum()), missed, recall, of_random)
    return Measured(name, len(chain.low), build_s, arm.size_mb, yes_us, no_us, *counts)


def _random_recall(
    arm: MappedArm, described: DescribedArm, heights_m: tuple[float, float], rng: np.random.Generator
) -> float:
    """Return the share found of the tool poses that random joints have within some heights, seen from the root (m)."""
    chain = described.chain
    low, high = np.maximum(chain.low, -np.pi), np.minimum(chain.high, np.pi)
    points, rotations = tool_poses(chain, rng.uniform(low, high, (POSTURES, len(low))))
    ahead = rotations[:, :, 0]
    is_asked = (points[:, 2] > heights_m[0]) & (points[:, 2] < heights_m[1]) & (ahead[:, 2] < -STEEP)
    if chain.rows == PITCH:  # a pitch past straight down is none that is asked
        is_asked &= (ahead[:, :2] * points[:, :2]).sum(axis=1) > 0.0
    return float(arm.can_reach(points[is_asked] + described.root, rotations[is_asked]).mean())


def _by_restarts(
    chain: Chain, points: FloatArray, rotations: FloatArray, asked: BoolArray, rng: np.random.Generator
) -> BoolArray:
    """Return which of the poses asked have joints that some random posture leads to."""
    found, left = np.zeros(len(points), dtype=np.bool_), np.flatnonzero(asked)
    low, high = np.maximum(chain.low, -np.pi), np.minimum(chain.high, np.pi)
    for _ in range(RESTARTS):
        starts = rng.uniform(low, high, (len(left), len(low)))
        has = solve_from(chain, points[left], rotations[left], chain.rows, starts)[0]
        found[left[has]] = True
        left = left[~has]
    return found


def _time_us(arm: MappedArm, points: FloatArray, rotations: FloatArray, repetitions: int) -> float:
    times = []
    for _ in range(repetitions):
        started = process_time()
        arm.can_reach(points, rotations)
        times.append(process_time() - started)
    return 1e6 * median(times) / len(points)


def _row(one: Measured) -> Row:
    line = (
        one.robot,
        count(one.joints),
        f"{one.build_s:.1f}",
        f"{one.map_mb:.1f}",
        f"{one.yes_us:.1f}",
        f"{one.no_us:.1f}",
        count(one.reachable),
        count(one.missed),
        f"{one.recall:.4f}",
        f"{one.random_recall:.4f}",
    )
    return Row((line,), asdict(one))
