"""The margins of a plan: what its own motions have to spare. They are read from it, nothing is planned again."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from planner.cloth.g_state import TableInGarment, needed_friction
from planner.geometry.pose import Approach, FloatArray
from planner.geometry.reach_query import ReachQuery
from planner.planning.problem import Problem
from planner.robots.card import JointLayout
from planner.task.plan import Plan
from planner.task.task import COMFORT_MAX_M
from planner.task.trajectory import Trajectory

TO_M = 0.001
"""Accuracy of the reach margin (m)."""

_ONE_STANDOFF = 1
_ALIKE_M = 1e-4
"""Distance of tool places below which they count as one (m)."""


@dataclass(frozen=True, slots=True)
class Margins:
    """The margins of a plan.

    Attributes:
        reach_m: the radius of the circle round each tool place, while cloth is held, that the arm reaches from where
            the base stands then and from the same direction, its joints' limits alone considered: the least of all,
            rounded down to a millimetre (m), and `COMFORT_MAX_M` where it is that or more; None where nothing is held.
        reach_step: the step that has it; None also where all have `COMFORT_MAX_M`.
        grips_m: by how much two grips held at once are further apart than two hands must be, the least of all (m); None
            where there is never more than one.
        friction: by how much the friction coefficient may be less before the cloth, left alone, slips.
        edge_m: how far the cloth, left alone, lies inside the table's edges, the least of all (m); negative where it
            hangs over.
    """

    reach_m: float | None
    reach_step: int | None
    grips_m: float | None
    friction: float
    edge_m: float


def margins_of(plan: Plan) -> Margins | None:
    """Return the margins of a plan; None where there is no plan."""
    if plan.trajectory is None:
        return None
    problem = Problem.of(plan.task)
    reach_m, reach_step = _reach(problem, plan, plan.trajectory)
    friction, edge_m = _rest(problem, plan)
    apart_m = [
        math.dist(one.point, other.point) - problem.context.grips_apart_m
        for step in plan.steps
        for one, other in combinations(step.holdings, 2)
    ]
    return Margins(reach_m, reach_step, min(apart_m, default=None), plan.scene.friction - friction, edge_m)


@dataclass(frozen=True, slots=True)
class _Hold:
    """The path of an arm's tool while it holds cloth in a step.

    Attributes:
        step: the step's index.
        arm: the arm's index.
        approach: the index of the direction from which it holds.
        places: the tool's places in the base frame, z above the floor, shape (n, 3), m.
    """

    step: int
    arm: int
    approach: int
    places: FloatArray


def _holds(problem: Problem, plan: Plan, path: Trajectory) -> Iterator[_Hold]:
    machine, layout = problem.robot, JointLayout.of(problem.robot.card)
    numbers = {approach: number for number, approach in enumerate(problem.context.reach.approaches)}
    for step in range(len(plan.steps)):
        rows: dict[tuple[int, Approach], list[FloatArray]] = {}
        for segment in path.of_step(step):
            first = bisect_left(path.arms.times_s, segment.start_s)
            after = bisect_right(path.arms.times_s, segment.start_s + segment.duration_s)
            for arm, hand in enumerate(segment.phase.hands):
                if hand is not None and hand.is_closed and not hand.is_reaching and after > first:
                    rows.setdefault((arm, hand.approach), []).append(path.arms.rows[first:after, layout.spans[arm]])
        for (arm, approach), joints in rows.items():
            places = machine.tool_places(arm, np.concatenate(joints), path.torso_m)
            alike = np.unique(np.round(places / _ALIKE_M), axis=0, return_index=True)[1]
            yield _Hold(step, arm, numbers[approach], places[np.sort(alike)])


def _reach(problem: Problem, plan: Plan, path: Trajectory) -> tuple[float | None, int | None]:
    """Return the reach margin (m) and its step."""

    def is_reached(hold: _Hold, radius_m: float) -> bool:
        reach = problem.robot.reach(path.torso_m, radius_m, is_passing=True, minds_body=False)
        return bool(reach.from_anywhere(ReachQuery(hold.arm, hold.places, np.array([hold.approach]))).all())

    least, tightest, is_any = round(COMFORT_MAX_M / TO_M), None, False
    for hold in _holds(problem, plan, path):
        is_any = True
        if is_reached(hold, least * TO_M):
            continue
        has, lacks = 0, least
        while lacks - has > 1:
            middle = (has + lacks) // 2
            has, lacks = (middle, lacks) if is_reached(hold, middle * TO_M) else (has, middle)
        least, tightest = has, hold.step
    return (round(least * TO_M, 3) if is_any else None), tightest


def _rest(problem: Problem, plan: Plan) -> tuple[float, float]:
    """Return the friction that cloth needs wherever it is left alone, and how far it lies inside the edges (m)."""
    sequence, table = problem.context.sequence, plan.scene.table
    frictions, insides_m = [], []
    for world in (plan.task.start, *(step.after for step in plan.steps)):
        if not world.held:
            cloth, top = sequence.cloth(world.done), TableInGarment.seen_from(world.placement, table)
            frictions.append(needed_friction(cloth, top))
            insides_m.append(float(top.inside(cloth.silhouette.coordinates).min()))
    return max(frictions, default=0.0), min(insides_m, default=0.0)
