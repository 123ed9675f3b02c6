"""Check whether a plan read from elsewhere can be performed step by step as it says.

Each step is compared with the cloth model and with the grips that the primitives would take. The trajectory is compared
with the robot: the tools are where the cloth is held, nothing is faster than its limit or speeds up harder,
and nothing touches.
"""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from planner.errors import FieldError, RequestError
from planner.geometry.pose import FloatArray, Pose2, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M, TIME_S
from planner.motion.opened_collisions import OpenedCollisions
from planner.planning.limits_check import require_limits
from planner.planning.problem import Problem
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.primitive import HeldTools
from planner.primitives.primitive_set import PRIMITIVES
from planner.primitives.state import State
from planner.robots.card import LOWERED_MAX_M, RAISED_MAX_M, JointLayout
from planner.task.plan import Plan, PlanStep
from planner.task.trajectory import Segment, Trajectory

TOOL_M = 0.005
"""Greatest distance between a tool and the point of the cloth that it holds (m)."""

_LAID = 1e-9
"""The share of a motion that rounding may leave when cloth lies."""

_SAMPLE_S = 0.05
"""Greatest time between the samples at which joints are checked (s)."""


def require_replay(plan: Plan) -> None:
    """Raise an error unless a solved plan can be performed as it says.

    Raises:
        FoldError: a fold is not legal on the cloth as the folds before it leave it.
        RequestError: names the step, as ``steps[2].grips``, and says what is wrong with which number.
    """
    problem = Problem.of(plan.task)
    if problem.stability_violation is not None:
        raise RequestError("task.start", problem.stability_violation.message)
    if plan.trajectory is None:
        return
    if not problem.is_goal(problem.state_of(plan.end)):
        raise RequestError("steps", "not all folds are done at the end")
    _require_segments(plan, plan.trajectory)
    require_limits(problem, plan.trajectory)
    collisions = OpenedCollisions(problem.robot, problem.context.scene.table, plan.trajectory.torso_m)
    for number, step in enumerate(plan.steps):
        try:
            _require_step(problem, step, plan.trajectory.of_step(number), plan.trajectory, collisions)
        except FieldError as error:
            raise error.within(f"steps[{number}]") from None


def _require_segments(plan: Plan, path: Trajectory) -> None:
    """Require that segments follow one another and belong to the steps as these are timed."""
    now = 0.0
    for number, segment in enumerate(path.segments):
        if abs(segment.start_s - now) > TIME_S:
            raise RequestError(f"trajectory.segments[{number}].start_s", f"is {segment.start_s}, not {now}")
        if not 0 <= segment.step < max(len(plan.steps), 1):
            raise RequestError(f"trajectory.segments[{number}].step", f"there is no step {segment.step}")
        now += segment.duration_s
    if abs(now - path.duration_s) > TIME_S or abs(path.duration_s - (plan.cost_s or 0.0)) > TIME_S:
        raise RequestError("trajectory.duration_s", f"is {path.duration_s}, its segments last {now}")


def _require_step(
    problem: Problem, step: PlanStep, segments: tuple[Segment, ...], path: Trajectory, collisions: OpenedCollisions
) -> None:
    before, after = problem.state_of(step.before), problem.state_of(step.after)
    _require_cloth(problem, step, before, after)
    tools = _tools(problem, step, before, after)
    for segment in segments:
        times_s = list(_moments(segment))
        _require_drive(problem, segment, times_s)
        for t_s in times_s:
            _require_arms(problem, segment, path, t_s, tools, collisions)


def _require_drive(problem: Problem, segment: Segment, times_s: list[float]) -> None:
    """Require that the base drives as it can in a segment of a trajectory.

    A differential base drives straight ahead or back, or turns where it stands; a fixed one does neither.

    Args:
        problem: the problem of the plan.
        segment: a segment of its trajectory.
        times_s: rising times, the segment's ends included (s).

    Raises:
        RequestError: says what the base would have to do, and when.
    """
    poses = [segment.base_at(t_s) for t_s in times_s]
    for (t_s, here), (_, there) in pairwise(zip(times_s, poses, strict=True)):
        fault = _undrivable(problem, here, there)
        if fault is not None:
            raise RequestError("trajectory", f"at {t_s:.2f} s the base {fault}")


def _undrivable(problem: Problem, here: Pose2, there: Pose2) -> str | None:
    """Return what is wrong with a stretch of the base's way; None if nothing is."""
    kind = problem.robot.card.base_kind
    x, y = there.x_m - here.x_m, there.y_m - here.y_m
    driven_m, turned_rad = math.hypot(x, y), abs(wrapped_angle(there.yaw_rad - here.yaw_rad))
    aside_m = abs(x * math.sin(here.yaw_rad) - y * math.cos(here.yaw_rad))
    moves, turns = driven_m > LENGTH_M, turned_rad > LENGTH_M
    if kind == "fixed" and (moves or turns):
        return "moves, and it is fixed"
    if kind == "differential" and aside_m > LENGTH_M:
        return f"drives {aside_m:.3f} m sideways, which a differential base cannot"
    return None


def _moments(segment: Segment) -> Iterator[float]:
    count = max(2, math.ceil(segment.duration_s / _SAMPLE_S) + 1)
    yield from (segment.start_s + float(t) for t in np.linspace(0.0, segment.duration_s, count))


def _require_cloth(problem: Problem, step: PlanStep, before: State, after: State) -> None:
    """Require that the cloth changes from the state before to the state after as a step of this kind changes it."""
    context, fold = problem.context, step.fold
    wanted = step.before.folds_done if fold is None else (*step.before.folds_done, fold)
    if step.after.folds_done != wanted:
        raise RequestError("after.folds_done", f"are {list(step.after.folds_done)}, not {list(wanted)}")
    if fold is not None:
        if fold not in context.sequence.dag.available(before.done):
            raise RequestError("details.fold", f"fold {fold} still waits for others")
        obstacle = geometric_obstacle(context, before, fold)
        if obstacle is not None and obstacle.says is not None:
            raise RequestError("details.fold", obstacle.says.text)
    violation = context.stability_violation(after.done, after.offset)
    if violation is not None:
        raise RequestError("after", violation.message)
    start, end = step.before.placement, step.after.placement
    moved_m = math.dist((start.x_m, start.y_m), (end.x_m, end.y_m))
    dragged_m = float(step.details.get("distance_m", 0.0))
    if abs(moved_m - dragged_m) > LENGTH_M or abs(end.yaw_rad - start.yaw_rad) > ANGLE_RAD:
        raise RequestError("after.placement", f"the garment has moved by {moved_m} m, not by {dragged_m} m")


def _tools(problem: Problem, step: PlanStep, before: State, after: State) -> HeldTools | None:
    """Return where the arms that hold cloth must have their tools; None if none does.

    Raises:
        RequestError: names what of the step cannot be, and why.
    """
    primitive = next((make(problem.context) for make in PRIMITIVES if make.kind == step.kind), None)
    if primitive is None:
        raise RequestError("kind", f"expected one of {', '.join(one.kind for one in PRIMITIVES)}; got {step.kind!r}")
    if not step.grips:
        return None
    names = problem.context.reach.arm_names
    taken = {names.index(holding.arm): holding.point for holding in step.holdings}
    return primitive.tools(step, taken, before, after)


def _held(tools: HeldTools, segment: Segment, t_s: float) -> dict[int, FloatArray]:
    """Return where each arm that holds cloth must have its tool at a time, table frame, shape (3,), m."""
    holding = [arm for arm, hand in enumerate(segment.phase.hands) if hand is not None and hand.is_closed]
    places = tools(segment, t_s)
    return {arm: places[arm] for arm in holding if arm in places}


def _require_arms(
    problem: Problem,
    segment: Segment,
    path: Trajectory,
    t_s: float,
    tools: HeldTools | None,
    collisions: OpenedCollisions,
) -> None:
    """Require that at a time the arms are where they must be, and nothing touches."""
    card, scene = problem.robot.card, problem.context.scene
    layout = JointLayout.of(card)
    joints = path.arms.at(t_s)
    base = segment.base_at(t_s)
    opened = np.array([[track.opening_at(t_s) for track in path.grippers]])
    stands = np.array([[base.x_m, base.y_m, base.yaw_rad]])
    if not collisions.is_path_free(stands, joints[None], opened):
        raise RequestError("trajectory", f"at {t_s:.2f} s the robot touches itself or the table")
    for arm_number, place in ({} if tools is None else _held(tools, segment, t_s)).items():
        own = joints[None, layout.spans[arm_number]]
        (tool,) = problem.robot.tool_places(arm_number, own, path.torso_m)
        off = _in_table(base, tool, scene.table.height_m) - place
        off_m = float(np.linalg.norm(off))
        is_laid = segment.fraction_at(t_s) > 1.0 - _LAID
        if off_m > TOOL_M and not (is_laid and _may_open(off)):
            message = f"at {t_s:.2f} s the {card.arms[arm_number].name} tool is {off_m:.3f} m from what it holds"
            raise RequestError("trajectory", message)


def _may_open(off: FloatArray) -> bool:
    """Return whether a hand may open so far from where its path ends, shape (3,), m: higher or lower, at an edge."""
    return math.hypot(off[0], off[1]) <= TOOL_M and -LOWERED_MAX_M - TOOL_M <= off[2] <= RAISED_MAX_M + TOOL_M


def _in_table(base: Pose2, tool: FloatArray, height_m: float) -> FloatArray:
    """Transform a tool's position from the base frame to the table frame, shape (3,), m."""
    return np.asarray(base.to_outer(tool) - np.array([0.0, 0.0, height_m]))
