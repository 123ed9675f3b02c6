"""An arm's motion from the left to the right of a box on the table: Pleat's paths of empty hands beside OMPL's.

Both get the same pairs of configurations, the tool 45 degrees down on either side of the box, and the same question of
whether a configuration is free: of box, table, the robot's body and its other arm. Pleat tries the straight line in
joint space, a list of detours, then its own RRT-Connect; OMPL plans with RRTConnect and simplifies what it finds.
OMPL's own time is small beside that of the questions, which it puts one by one; Pleat puts those of a line together.

OMPL is an extra, pinned in ``requirements-bench.txt``.
"""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from itertools import pairwise
from statistics import median
from time import process_time
from typing import Any

import numpy as np

from bench.measurement import Ratio
from bench.report import ABSENT, Report, Row
from planner.geometry.pose import Approach, BoolArray, FloatArray, Pose2
from planner.motion.lying_cloth import LyingCloth
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.transfer_planner import MARGIN_M
from planner.motion.transit_paths import STEP_RAD, TransitPaths
from planner.planning.problem import Problem
from planner.planning.robot_task import task_for
from planner.planning.warm_up import compile_kernels, napkin
from planner.robots.described_robot import read_robot

COLUMNS = ("robot", "planner", "found", "median [ms]", "95 % [ms]", "way, median [rad]", "times as long")
ROBOTS = ("panda-pair", "ur5e-single")
MOTIONS, FEW_MOTIONS = 20, 5
SEED = 3

BOX_M = (0.3, 0.12, 0.25)
"""The box: its depth and width on the table, and its height (m); it stands in the middle of the table."""

NEAR_M, ASIDE_M, LOW_M = 0.12, 0.1, 0.05
"""How far beside the box a tool is at least, how much further at most, and how far over the table at least (m)."""

PITCH_RAD = np.pi / 4.0
LIMIT_S = 5.0
"""The time after which OMPL gives up (s)."""


@dataclass(frozen=True, slots=True)
class Motions:
    """The motions of a robot's first arm.

    Attributes:
        name: the robot.
        transits: Pleat's paths of empty hands.
        collisions: the robot's collisions at its table.
        base: the base's pose, table frame.
        box: the box, as cloth above which arms keep its height.
        pairs: starts and goals of all arms (rad), shape (n, 2, joints); only the first arm's differ.
    """

    name: str
    transits: TransitPaths
    collisions: OpenedCollisions
    base: Pose2
    box: LyingCloth
    pairs: FloatArray

    @property
    def span(self) -> slice:
        """The first arm's part of a configuration."""
        return self.transits.layout.spans[0]

    def are_all_free(self, joints: FloatArray) -> bool:
        """Return whether nothing touches in any configuration of all arms, shape (n, joints)."""
        are_clear = self.box.arm_clear(0, self.base, joints[:, self.span])
        return bool(are_clear.all()) and self.collisions.wide.is_path_free(self.base, joints)


@dataclass(frozen=True, slots=True)
class Measured:
    """The paths that a planner found for a robot's motions.

    Attributes:
        planner: the planner.
        found: how many motions it found a path for that touches nothing.
        times_ms: the CPU time of each motion (ms).
        ways_rad: the length of each path found, in joint space (rad).
    """

    planner: str
    found: int
    times_ms: tuple[float, ...]
    ways_rad: tuple[float, ...]


Planner = Callable[[FloatArray, FloatArray], FloatArray | None]
"""A planner: from all arms' joints at the start and at the goal to configurations, shape (n, joints), or None."""


def round_a_box(_garments: Sequence[str], repetitions: int) -> Report:
    """Measure the motions of a Panda and a UR5e; the garments do not matter."""
    count = MOTIONS if repetitions > 1 else FEW_MOTIONS
    rows = tuple(_row(name, _measured(name, count)) for name in ROBOTS)
    title = f"An arm from the left to the right of a box {BOX_M[2]:.2f} m high, {count} motions in turns"
    return Report("round-a-box", title, COLUMNS, rows, 1)


def _measured(name: str, count: int) -> list[Measured]:
    """Return what Pleat and its peers found for each motion of a robot, in turns."""
    compile_kernels(name)
    motions = motions_of(name, count)
    planners = {"Pleat": _pleat(motions)} | ({"OMPL": _ompl(motions)} if find_spec("ompl") else {})
    times: dict[str, list[float]] = {planner: [] for planner in planners}
    ways: dict[str, list[float]] = {planner: [] for planner in planners}
    for number, (start, goal) in enumerate(motions.pairs):
        for planner, planned in planners.items():
            began = process_time()
            way = planned(start, goal)
            if number == 0:
                continue  # loads what is loaded once
            times[planner].append(1e3 * (process_time() - began))
            if way is not None and _is_free(motions, way):
                ways[planner].append(float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum()))
    return [Measured(planner, len(ways[planner]), tuple(times[planner]), tuple(ways[planner])) for planner in planners]


def motions_of(name: str, count: int) -> Motions:
    """Return some motions of a robot's first arm, and one before them; their ends are free."""
    problem = Problem.of(task_for(napkin(name), robot=name))
    scene, robot = problem.context.scene, problem.robot
    collisions = OpenedCollisions(robot, scene.table, scene.torso_m, MARGIN_M)
    transits = TransitPaths(robot, collisions, scene.torso_m)
    base = problem.context.base_pose(problem.start.station, problem.start.standoff)
    corners = 0.5 * np.array(BOX_M[:2]) * [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
    motions = Motions(
        name, transits, collisions, base, LyingCloth(b"box", (corners,), collisions, BOX_M[2]), np.empty(0)
    )
    rng = np.random.default_rng(SEED)

    def end(side: float) -> FloatArray:
        """Return all arms' joints with the first one's tool at a random place on a side of the box."""
        joints = transits.home.copy()
        while True:
            aside_m, ahead_m, over_m = rng.uniform((0.0, -0.5, LOW_M), (ASIDE_M, 0.5, 3.0 * LOW_M))
            place = (BOX_M[0] * ahead_m, side * (0.5 * BOX_M[1] + NEAR_M + aside_m), scene.table.height_m + over_m)
            point, heading = _in_base(base, place), float(rng.uniform(-1.0, 1.0))
            found = robot.free_postures(
                0, point, Approach(heading, PITCH_RAD).rotation, scene.torso_m, partial(_alone, motions)
            )
            if len(found):
                joints[motions.span] = found[rng.integers(len(found))]
                return joints

    return replace(motions, pairs=np.array([[end(1.0), end(-1.0)] for _ in range(count + 1)]))


def _alone(motions: Motions, joints: FloatArray) -> BoolArray:
    """Return at which joints of the first arm, shape (n, joints), nothing touches while the others are at home."""
    every = np.tile(motions.transits.home, (len(joints), 1))
    every[:, motions.span] = joints
    return np.array([motions.are_all_free(row[None]) for row in every], dtype=np.bool_)


def _in_base(base: Pose2, place: tuple[float, float, float]) -> FloatArray:
    """Return a place of the table frame, over the floor, in the base frame (m)."""
    x, y, cos, sin = place[0] - base.x_m, place[1] - base.y_m, np.cos(base.yaw_rad), np.sin(base.yaw_rad)
    return np.array([cos * x + sin * y, cos * y - sin * x, place[2]])


def _is_free(motions: Motions, way: FloatArray) -> bool:
    """Return whether nothing touches all along a path, tested as finely as Pleat tests its own."""
    counts = [max(1, int(np.ceil(np.abs(end - start).max() / STEP_RAD))) for start, end in pairwise(way)]
    lines = [np.linspace(start, end, count + 1) for (start, end), count in zip(pairwise(way), counts, strict=True)]
    return motions.are_all_free(np.vstack(lines))


def _pleat(motions: Motions) -> Planner:
    nowhere = np.zeros(len(motions.transits.layout.arms))  # the hands may be low nowhere
    return lambda start, goal: motions.transits.way(motions.base, start, goal, motions.box, (nowhere, nowhere))


def _ompl(motions: Motions) -> Planner:
    """Return OMPL's RRTConnect with simplification; it tests lines about as finely as Pleat does."""
    base, geometric, util = (import_module(f"ompl.{name}") for name in ("base", "geometric", "util"))
    util.noOutputHandler()
    util.RNG.setSeed(SEED)
    chain, every = read_robot(motions.name).arms[0].chain, motions.transits.home.copy()
    count = len(chain.low)
    space, bounds = base.RealVectorStateSpace(count), base.RealVectorBounds(count)
    for joint, (low, high) in enumerate(zip(chain.low.tolist(), chain.high.tolist(), strict=True)):
        bounds.setLow(joint, low)
        bounds.setHigh(joint, high)
    space.setBounds(bounds)

    def is_free(state: Any) -> bool:  # noqa: ANN401
        every[motions.span] = [state[joint] for joint in range(count)]
        return motions.are_all_free(every[None])

    def planned(start: FloatArray, goal: FloatArray) -> FloatArray | None:
        setup = geometric.SimpleSetup(space)
        setup.setStateValidityChecker(is_free)
        about = setup.getSpaceInformation()
        about.setStateValidityCheckingResolution(STEP_RAD / space.getMaximumExtent())
        setup.setPlanner(geometric.RRTConnect(about))
        ends = []
        for joints in (start, goal):
            state = space.allocState()
            for joint, value in enumerate(joints[motions.span].tolist()):
                state[joint] = value
            ends.append(state)
        setup.setStartAndGoalStates(*ends)
        if not setup.solve(LIMIT_S) or not setup.haveExactSolutionPath():
            return None
        setup.simplifySolution()
        states = setup.getSolutionPath().getStates()
        way = np.tile(start, (len(states), 1))
        way[:, motions.span] = [[state[joint] for joint in range(count)] for state in states]
        return way

    return planned


def _row(name: str, measured: Sequence[Measured]) -> Row:
    """Return a robot's lines, one for each planner; its peers' with how often they took as long as Pleat."""
    ours, *peers = measured
    ratios = {peer.planner: Ratio.of(peer.times_ms, ours.times_ms) for peer in peers}
    lines = []
    for one in measured:
        median_ms, late_ms = np.quantile(one.times_ms, (0.5, 0.95))
        way = f"{median(one.ways_rad):.1f}" if one.ways_rad else ABSENT
        found = f"{one.found} of {len(one.times_ms)}"
        ratio = str(ratios.get(one.planner, ABSENT))
        lines.append(
            (name if one is ours else "", one.planner, found, f"{median_ms:.1f}", f"{late_ms:.1f}", way, ratio)
        )
    data = {"robot": name, "planners": [asdict(one) for one in measured]}
    return Row(tuple(lines), data | {"time_ratios": {peer: asdict(ratio) for peer, ratio in ratios.items()}})
