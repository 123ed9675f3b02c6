"""Whether a plan's motion could be sent to a robot: no velocity jumps, nothing is too fast or speeds up too hard.

Between two keyframes everything is a cubic, so its acceleration is greatest at one of them: nothing lies between.
"""

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from planner import Plan
from planner.robots.card import RobotCard

RISE_S, FINGER_RISE_S = 0.25, 0.08
TURN_RAD_S2 = 1.0
MOST = 1.02
Floats = NDArray[np.float64]


def require_smooth(plan: Plan, card: RobotCard) -> None:
    """Fail unless velocities are continuous within the steps, all rests between them, and every limit is kept."""
    path = plan.trajectory
    assert path is not None
    assert path.duration_s == plan.cost_s
    speeds = np.array([speed for arm in card.arms for speed in arm.speeds_rad_s])
    given = [arm.accelerations or [speed / RISE_S for speed in arm.speeds_rad_s] for arm in card.arms]
    times, arms = np.array(path.arms.times_s), np.array(path.arms.velocities)
    _require("the arms", times, np.array(path.arms.positions), arms, speeds, np.concatenate(given))
    for arm, track in zip(card.arms, path.grippers, strict=True):
        top = np.array([arm.gripper.speed])
        positions, velocities = np.array(track.positions)[:, None], np.array(track.velocities)[:, None]
        _require(f"{arm.name} fingers", np.array(track.times_s), positions, velocities, top, top / FINGER_RISE_S)
    _require_base(plan, card)
    for step in plan.steps:
        for t_s in (step.start_s, step.end_s):
            assert np.abs(path.arms.velocities_at(t_s)).max() < 1e-9, f"the arms move at {t_s} s"


def _require(what: str, times: Floats, values: Floats, rates: Floats, speeds: Floats, accelerations: Floats) -> None:
    if len(times) < 2:
        return
    gaps = np.diff(times)[:, None]
    assert gaps.min() > 0.0, f"{what}: times do not grow"
    means, before, after = np.diff(values, axis=0) / gaps, rates[:-1], rates[1:]
    first, last = (6.0 * means - 4.0 * before - 2.0 * after) / gaps, (2.0 * before + 4.0 * after - 6.0 * means) / gaps
    hardest = np.maximum(np.abs(first), np.abs(last)) / accelerations
    worst = np.unravel_index(hardest.argmax(), hardest.shape)
    assert hardest.max() <= MOST * (1.0 + 1e-6), f"{what} {worst[1]} at {times[worst[0]]:.3f} s: {hardest.max():.3f}"
    for share in np.linspace(0.0, 1.0, 9):
        at = before + share * gaps * (first + 0.5 * share * (last - first))
        assert (np.abs(at) / speeds).max() <= 1.0 + 1e-6, f"{what}: too fast"


def _require_base(plan: Plan, card: RobotCard) -> None:
    path, scene = plan.trajectory, plan.scene
    assert path is not None
    step, at_end = -1, np.zeros(3)
    for segment in path.segments:
        start, end = segment.phase.base
        turned = math.remainder(end.yaw_rad - start.yaw_rad, math.tau)
        way = np.array([end.x_m - start.x_m, end.y_m - start.y_m, turned])
        if not way.any():
            assert np.abs(at_end).max() < 1e-9, "the base stops at once"
            continue
        rates = np.array(segment.base_rates)[:, None]
        length, speed, hard = np.hypot(way[0], way[1]), scene.base_speed_m_s, card.base_acceleration_m_s2
        limits = [(length, speed, hard), (abs(turned), scene.base_turn_rad_s, TURN_RAD_S2)]
        for far, fast, harder in limits:
            if far > 1e-5:
                ways, velocities = far * np.array(segment.fractions)[:, None], far * rates
                _require("the base", np.array(segment.times_s), ways, velocities, np.array([fast]), np.array([harder]))
        if segment.step != step:
            at_end = np.zeros(3)
        assert np.abs(rates[0] * way - at_end).max() < 1e-6, f"the base's velocity jumps at {segment.start_s} s"
        step, at_end = segment.step, rates[-1] * way
    assert np.abs(at_end).max() < 1e-9, "the base drives at the end"
    for one, other in pairwise(path.segments):
        if one.step != other.step:
            ends = [part.base_velocity_at(other.start_s) for part in (one, other)]
            assert np.abs(ends).max() < 1e-9, f"the base drives from step {one.step} to {other.step}"
