"""Slows a plan's motion down for what is made of it."""

from collections.abc import Sequence
from dataclasses import replace

from planner.errors import RequestError
from planner.task.plan import Plan
from planner.task.trajectory import ArmTrack, GripperTrack, Segment, Trajectory

SPEEDS = (0.05, 1.0)
"""Range of the speed, as a share of the planned one."""


def require_speed(speed: float) -> None:
    """Refuse a speed out of range; raises `RequestError`."""
    if not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise RequestError("speed", f"expected {SPEEDS[0]:g} to {SPEEDS[1]:g}, got {speed:g}")


def slowed(plan: Plan, speed: float) -> Plan:
    """Return a plan whose motion takes the same path at a share of its speed; an unsolved plan as it is.

    Times are divided by the speed, velocities multiplied by it; accelerations fall with its square.

    Args:
        plan: the plan.
        speed: the share of the planned speed, within `SPEEDS`.
    """
    if plan.trajectory is None or speed == 1.0:
        return plan
    steps = tuple(
        replace(step, start_s=step.start_s / speed, duration_s=step.duration_s / speed) for step in plan.steps
    )
    return replace(plan, steps=steps, trajectory=_slowed(plan.trajectory, speed))


def _slowed(path: Trajectory, speed: float) -> Trajectory:
    return replace(
        path,
        duration_s=path.duration_s / speed,
        segments=tuple(_segment(segment, speed) for segment in path.segments),
        arms=_arms(path.arms, speed),
        grippers=tuple(_gripper(track, speed) for track in path.grippers),
    )


def _segment(segment: Segment, speed: float) -> Segment:
    return replace(
        segment,
        start_s=segment.start_s / speed,
        phase=replace(segment.phase, duration_s=segment.phase.duration_s / speed),
        times_s=_times(segment.times_s, speed),
        rates=_rates(segment.rates, speed),
        base_rates=_rates(segment.base_rates, speed),
    )


def _arms(arms: ArmTrack, speed: float) -> ArmTrack:
    velocities = tuple(_rates(row, speed) for row in arms.velocities)
    return replace(arms, times_s=_times(arms.times_s, speed), velocities=velocities)


def _gripper(track: GripperTrack, speed: float) -> GripperTrack:
    return replace(
        track,
        times_s=_times(track.times_s, speed),
        opening_rates=_rates(track.opening_rates, speed),
        velocities=_rates(track.velocities, speed),
    )


def _times(times_s: Sequence[float], speed: float) -> tuple[float, ...]:
    return tuple(time_s / speed for time_s in times_s)


def _rates(rates: Sequence[float], speed: float) -> tuple[float, ...]:
    return tuple(rate * speed for rate in rates)
