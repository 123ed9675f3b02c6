"""Writes a plan as a table: one row per primitive, with the positions of the hands in the table and the base frame.

The base may drive during a fold, so the table has its pose at three moments: when the hands pick the cloth, at the top
of the path, and when they place it. A point in the base frame uses the base's pose at its own moment. Heights in the
base frame are above the floor, in the table frame above the table top.

Transforms leave noise in the last digits of a point. Numbers are rounded to the planner's resolution, which is far
above that noise.
"""

import csv
import io
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from app.step_kinds import step_words
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import Point3, Pose2
from planner.geometry.tolerance import ANGLE_RAD, DECIMALS
from planner.task.plan import Plan, PlanStep
from planner.task.trajectory import Phase, Segment
from planner.task.world_state import Grip

MOMENTS = ("pick", "apex", "place")
_FORMULA = ("=", "+", "-", "@")


def plan_table(plan: Plan) -> str:
    """Return a solved plan as comma-separated values, a header row first; lengths in m, times in s, angles in rad.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    if plan.trajectory is None:
        raise UnsolvedPlanError(plan.status)
    arms = [track.arm for track in plan.trajectory.grippers]
    text = io.StringIO()
    writer = csv.DictWriter(text, list(_names(arms)))
    writer.writeheader()
    for number, step in enumerate(plan.steps):
        row = _row(plan, number, step, plan.trajectory.of_step(number))
        writer.writerow({name: _cell(value) for name, value in row.items()})
    return text.getvalue()


def _cell(value: object) -> object:
    return round(value, DECIMALS) + 0.0 if isinstance(value, float) else value


def _names(arms: list[str]) -> Iterator[str]:
    yield from ("primitive", "kind", "what", "fold", "holds", "distance_m")
    yield from ("start_s", "end_s", "duration_s", "driving_s", "arms_s")
    yield from ("station", "back_off_m", "base_x_m", "base_y_m", "base_yaw_rad")
    for moment in MOMENTS:
        yield from (f"base_at_{moment}_{field}" for field in ("x_m", "y_m", "yaw_rad"))
    for arm in arms:
        for moment in MOMENTS:
            yield from (f"{arm}_{moment}_in_table_{axis}_m" for axis in "xyz")
            yield from (f"{arm}_{moment}_in_base_{axis}_m" for axis in "xyz")


def _row(plan: Plan, number: int, step: PlanStep, segments: Sequence[Segment]) -> dict[str, Any]:
    details, base = step.details, step.base
    driving_s = sum(part.duration_s for part in segments if part.phase.base[0] != part.phase.base[1])
    row = {
        "primitive": number,
        "kind": step.kind,
        "what": _text(step_words(step, plan.garment)),
        **{name: details.get(name, "") for name in ("fold", "holds", "distance_m")},
        "start_s": step.start_s,
        "end_s": step.end_s,
        "duration_s": step.duration_s,
        "driving_s": driving_s,
        "arms_s": step.duration_s - driving_s,
        "station": _text(base.station or ""),
        "back_off_m": base.back_off_m,
        **_pose("base", base.pose),
    }
    for moment, pose in _stands([part.phase for part in segments]).items():
        points = [(grip.arm, point) for grip in step.grips if (point := _point(grip, moment)) is not None]
        if points:
            row |= _pose(f"base_at_{moment}", pose)
        for arm, point in points:
            row |= _columns(f"{arm}_{moment}_in_table", point)
            row |= _columns(f"{arm}_{moment}_in_base", _in_base(plan, pose, point))
    return row


def _stands(phases: Sequence[Phase]) -> dict[str, Pose2]:
    """Return the base's pose when the hands take hold, when they reach the top of a fold's path, and at the end."""
    held = [phase for phase in phases if any(hand is not None and hand.is_closed for hand in phase.hands)]
    if not held:
        return {}
    stands = {"pick": held[0].base[0], "place": held[-1].base[1]}
    apex = next((phase for phase in held if _comes_to_apex(phase)), None)
    return stands if apex is None else {**stands, "apex": apex.base[1]}


def _comes_to_apex(phase: Phase) -> bool:
    first, last = phase.cloth.sweep
    return phase.cloth.fold is not None and first < last and abs(last - 1.0) <= ANGLE_RAD


def _point(grip: Grip, moment: str) -> Point3 | None:
    return {"pick": grip.pick, "apex": grip.apex, "place": grip.place}[moment]


def _in_base(plan: Plan, base: Pose2, point: Point3) -> Point3:
    """Return a point of the table frame in the base frame, its height above the floor (m)."""
    x, y, z = base.to_inner(np.array(point) + np.array([0.0, 0.0, plan.scene.table.height_m]))
    return (float(x), float(y), float(z))


def _columns(name: str, point: Point3) -> dict[str, float]:
    return {f"{name}_{axis}_m": value for axis, value in zip("xyz", point, strict=True)}


def _pose(name: str, pose: Pose2) -> dict[str, float]:
    return {f"{name}_{field}": value for field, value in pose.to_dict().items()}


def _text(text: str) -> str:
    """Return a text that no spreadsheet takes for a formula."""
    return f"'{text}" if text.startswith(_FORMULA) else text
