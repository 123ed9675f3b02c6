"""Small problems that have no plan, and checks that a reason is gone."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any, Unpack

from planner import Scene, Task, find_plan
from planner.cloth.garment import Garment
from planner.geometry.pose import Point2, Pose2
from planner.geometry.table import Table
from planner.planning.found_plan import FoundPlan
from planner.primitives.g_fold import GFold
from planner.primitives.state import State
from planner.task.plan import Plan
from planner.task.reason import Code, Reason
from tests.builders import SceneFields, fold, garment, rectangle_points
from tests.planning.found import found_plan

BACK = -math.pi / 2
"""The yaw that lays a drawing's y along the table's x, away from `front`, and its x to the right."""

FRONT = (("front", Pose2(-0.95, 0.0, 0.0)),)

LEVEL_M = 0.051 + 0.739675 + 0.29 - 0.02 - 0.18
"""The table height at which a tool that points straight down at rest, 2 cm up, has its wrist level with the shoulders:
base_link + torso + raised by - rest - tool (m)."""


COMFORT_M = 0.03

UPPER_M, FORE_M = 0.4, 0.321
"""The lengths of the upper arm and the forearm (m)."""

STRAIGHT_M = math.sqrt(UPPER_M**2 + FORE_M**2 + 2.0 * UPPER_M * FORE_M * math.cos(0.15))
"""How far a wrist can be from the axis of the shoulder's lift, the elbow bent by its soft limit, 0.15 rad (m)."""

FURTHEST_X = -0.95 - 0.05 + 0.1 + STRAIGHT_M
"""How far ahead of `front` the far end of a strip can be at a table of that height (m). It is pinched from beyond it,
which only a hand that points straight down can; its wrist is level with the shoulder, which is 5 cm behind the base's
middle, and at most 0.1 m + `STRAIGHT_M` from the shoulder's pan axis: 0.1 m ahead of it is the lift's."""

HOUSE = ((0.4, 0.3), (0.0, 0.3), (0.0, -0.1), (0.2, -0.2), (0.4, -0.1))
"""A house upside down: its roof's tip hangs 0.1 m below its eaves, which are 0.1 m below the line at y = 0."""

HAMMER_SCENE = Scene(stations=(("front", Pose2(-0.8, 0.0, 0.0)),))


def fixed(height_m: float = LEVEL_M, **fields: Unpack[SceneFields]) -> Scene:
    """Return a scene in which the robot stands still before the table, so that nothing is dragged."""
    return replace(Scene(stations=FRONT, back_off_max_m=0.0, table=Table(height_m=height_m)), **fields)


def strip(far_x_m: float, length_m: float, depth_m: float, y_m: float = 0.188) -> Garment:
    """Return a strip 0.1 m wide along the table's x, its far end to be folded back over a line `depth_m` from it.

    One grip in the middle of the far end holds both its corners, 0.05 m away. The strip's middle is before the left
    shoulder, so what counts for the left arm is the distance ahead.
    """
    line = length_m - depth_m
    far_end = fold((0.0, line), (0.1, line), name="far end")
    return garment(rectangle_points(0.1, length_m), far_end, placement=Pose2(far_x_m - length_m, y_m + 0.05, BACK))


def refused(cloth: Garment, scene: Scene | None = None) -> Plan:
    """Return the answer, which must have no plan."""
    return met(cloth, scene).plan


@cache
def met(cloth: Garment, scene: Scene | None = None) -> FoundPlan:
    """Return the answer, which must have no plan, and all reasons that were met before that was known.

    Each is made once in a test run and shared, so its context is not to be changed.
    """
    answer = found_plan(cloth, scene, time_limit_s=60.0)
    assert answer.plan.status == "infeasible"
    return answer


def but_for_collisions(answer: Plan) -> Reason:
    """Return the only reason of an answer, if only collisions have to be fixed with it."""
    reason, *others = answer.reasons
    assert all((other.code, other.set) == (Code.COLLISION, reason.set) for other in others)
    return reason


def requested(change: Mapping[str, Any], cloth: Garment, scene: Scene | None = None) -> Task:
    """Return the task of a request with a change put into it, as a client would."""
    parts = {"garment": Garment.from_dict, "scene": Scene.from_dict, "placement": lambda pose: Pose2(**pose)}
    options = {name: parts.get(name, float)(value) for name, value in change.items()}
    request: dict[str, Any] = {"garment": cloth, "scene": scene, **options}
    return Task.of(request.pop("garment"), request.pop("scene"), **request)


def planned_with(
    change: Mapping[str, Any], cloth: Garment, scene: Scene | None = None, *, with_reasons: bool = False
) -> Plan:
    """Return the plan of a request with a change put into it; reasons only if asked for."""
    return plan_of(requested(change, cloth, scene), with_reasons=with_reasons)


def plan_of(task: Task, *, with_reasons: bool = False) -> Plan:
    """Return the plan of a task, with time enough for a cold machine; each is made once in a test run."""
    return _plan_of(replace(task, limits=replace(task.limits, time_limit_s=60.0)), with_reasons)


@cache
def _plan_of(task: Task, with_reasons: bool) -> Plan:
    return find_plan(task, with_reasons=with_reasons).plan


def is_gone(reason: Reason, answer: Plan) -> bool:
    """Return whether a plan is solved, or at least has no reason of this kind any more."""
    kind = (reason.fold, reason.code, reason.cause, reason.arm, reason.station)
    return all((r.fold, r.code, r.cause, r.arm, r.station) != kind for r in answer.reasons)


def is_in_reach(answer: FoundPlan, number: int) -> bool:
    """Return whether a fold is possible at the start for arms without obstacles."""
    state = State(0, (0.0, 0.0), 0, 0)
    return any(step.after.done >> number & 1 for step in GFold(answer.context).successors(state))


def hammer() -> Garment:
    """Return a hammer whose head, at y = 0.4 to 0.5, points away from the robot, to be folded back over y = 0.1."""
    outline: list[Point2] = [(0, 0), (0.3, 0), (0.3, 0.2), (0.2, 0.2), (0.2, 0.4), (0.3, 0.4)]
    outline += [(0.3, 0.5), (0, 0.5), (0, 0.4), (0.1, 0.4), (0.1, 0.2), (0, 0.2)]
    return garment(outline, fold((0.0, 0.1), (0.3, 0.1), name="hammer"), placement=Pose2(-0.65, 0.15, BACK))
