"""Read the motions of hands that hold cloth from a plan's trajectory, step by step, for any robot."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from app.rehearsal.camera.posture import Posture
from app.rehearsal.world import GripMotion, StepMotion
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import Point3, Pose2
from planner.task.plan import Plan, PlanStep
from planner.task.trajectory import Hand, Segment, Trajectory

_SIDE_BY_SIDE_RAD = math.radians(59.0)
"""The pitch from which on fingers close along the table (see `planner.robots.edge_grip`), 60 degrees, with a margin."""


def step_motions(plan: Plan) -> tuple[StepMotion, ...]:
    """Return the motions of a plan's steps.

    Raises:
        UnsolvedPlanError: the plan has no trajectory.
    """
    path = plan.trajectory
    if path is None:
        raise UnsolvedPlanError(plan.status)
    closed = [_closed(path, number) for number in range(len(plan.steps))]
    held = {point.arm for point in plan.task.start.held}
    found = []
    for number, step in enumerate(plan.steps):
        after = set(closed[number + 1]) if number + 1 < len(plan.steps) and step.details.get("holds") else set()
        grips = tuple(
            GripMotion(
                arm, path.times_s, path.points, arm not in held, arm not in after, path.turned_rad, path.heading_rad
            )
            for arm, path in closed[number].items()
        )
        last = path.of_step(number)[-1]
        ends = posture_at(path, last.start_s + last.duration_s)
        found.append(StepMotion(number, step.kind, step.duration_s, grips, base=_driven(step), ends=ends))
        held = set(closed[number]) & after
    return tuple(found)


def posture_at(path: Trajectory, t_s: float) -> Posture:
    """Return the robot's base and joints at a time of the plan (s)."""
    return Posture(path.segment_at(t_s).base_at(t_s), path.joints_at(t_s))


def _driven(step: PlanStep) -> Pose2 | None:
    """Return where the base stands after a step in which it changes its station."""
    return None if step.before.base.station == step.base.station else step.base.pose


@dataclass(frozen=True, slots=True)
class _Path:
    """The path of a tool that holds cloth: times since the step's start (s), points (m), and how far it has rolled.

    The direction in which its fingers point is None where they are side by side.
    """

    times_s: tuple[float, ...]
    points: tuple[Point3, ...]
    turned_rad: tuple[float, ...]
    heading_rad: float | None


def _closed(path: Trajectory, step: int) -> dict[str, _Path]:
    """Return the path of each arm that holds cloth in a step."""
    segments = path.of_step(step)
    found: dict[str, _Path] = {}
    for number, gripper in enumerate(path.grippers):
        rows = [row for segment in segments for row in _rows(segment, segment.phase.hands[number])]
        if rows:
            times, points, turned = zip(*_rising(rows), strict=True)
            began = segments[0].start_s
            found[gripper.arm] = _Path(
                tuple(t - began for t in times), points, turned if any(turned) else (), _heading(segments, number)
            )
    return found


def _heading(segments: Sequence[Segment], number: int) -> float | None:
    """Return the direction in which the fingers of an arm point as they hold cloth, table frame (rad)."""
    for segment in segments:
        hand = segment.phase.hands[number]
        if hand is not None and hand.is_closed and not hand.is_reaching:
            is_flat = hand.approach.pitch_rad < _SIDE_BY_SIDE_RAD
            return hand.approach.heading_rad + segment.phase.base[0].yaw_rad if is_flat else None
    return None


_Row = tuple[float, Point3, float]
"""A time (s), a point (m), and a roll without its sign (rad): whichever arm it is, a hand rolls as the cloth turns."""


def _rows(segment: Segment, hand: Hand | None) -> Iterator[_Row]:
    if hand is None or not hand.is_closed or hand.is_reaching:
        return
    at = np.linspace(0.0, 1.0, len(hand.points))
    # The corners of the path come in between the segment's own keyframes.
    fractions = np.unique(np.concatenate([at, np.asarray(segment.fractions)]))
    times = np.interp(fractions, segment.fractions, segment.times_s) + segment.start_s
    rolls = np.abs(hand.rolls_rad or (0.0,) * len(hand.points))
    columns = [np.interp(fractions, at, axis) for axis in (*np.array(hand.points).T, rolls)]
    for time, x, y, z, roll in np.column_stack([times, *columns]).tolist():
        yield time, (x, y, z), roll


def _rising(rows: list[_Row]) -> Iterator[_Row]:
    """Yield the rows whose time is later than that of the one before; of two at one time the first."""
    last = -1.0
    for row in rows:
        if row[0] > last:
            yield row
            last = row[0]
