"""A robot that nobody ships: two small arms on a base with two wheels, which cannot drive sideways."""

import json
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from planner import Plan, Scene, make_plan
from planner.errors import RequestError
from planner.geometry.pose import Pose2, wrapped_angle
from planner.motion.motion_values import positions_at, velocities_at
from planner.planning.plan_check import require_replay
from planner.planning.robot_task import default_scene
from planner.robots import described_robot
from planner.robots.load_robot import load_robot
from planner.task.trajectory import Segment, Trajectory
from tests.builders import fold, garment
from tests.replay.smooth import require_smooth

WHEEL_M, TRACK_M, WHEEL_RAD_S = 0.05, 0.3, 6.0
"""Radius and distance of the wheels (m), and how fast they turn (rad/s)."""

RIM_M_S = WHEEL_M * WHEEL_RAD_S


def write_card(folder: Path) -> Path:
    """Write the card of the SO-101 pair on such a base, with a station at each of two edges; return its path."""
    card = json.loads((Path(described_robot.__file__).parent / "cards" / "so101-pair.json").read_text())
    card |= {"name": "two-wheels", "title": "Two SO-101 on two wheels"}
    speeds = {"speed_m_s": RIM_M_S, "turn_rad_s": 2.0 * RIM_M_S / TRACK_M}
    card["base"] = {"kind": "differential", "radius_m": 0.3, "size_m": [0.12, 0.45], **speeds}
    left = {"x_m": 0.0, "y_m": 0.43, "yaw_rad": -math.pi / 2}
    card["scene"]["stations"] = {"edge": {"x_m": -0.33, "y_m": 0.0, "yaw_rad": 0.0}, "left": left}
    path = folder / "two-wheels.json"
    path.write_text(json.dumps(card))
    return path


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(write_card(tmp_path_factory.mktemp("two_wheels")))


@pytest.fixture(scope="module")
def scene(robot: str) -> Scene:
    return replace(default_scene(robot), back_off_max_m=0.0)


@pytest.fixture(scope="module")
def plan(robot: str, scene: Scene) -> Plan:
    """Return a plan for a napkin that can be folded from the front edge, with the robot at the left one."""
    napkin = garment([(0.0, 0.0), (0.2, 0.0), (0.2, 0.16), (0.0, 0.16)], fold((0.1, 0.16), (0.1, 0.0)))
    return make_plan(napkin, scene, robot=robot, start_station="left", time_limit_s=60.0)


def trajectory(plan: Plan) -> Trajectory:
    assert plan.trajectory is not None
    return plan.trajectory


def rims_m_s(forward_m_s: np.ndarray, turn_rad_s: np.ndarray) -> np.ndarray:
    """Return the speed of the faster wheel's rim (m/s)."""
    return np.asarray(np.abs(forward_m_s) + np.abs(turn_rad_s) * TRACK_M / 2)


def test_it_drives_round_the_table_and_folds(plan: Plan) -> None:
    assert plan.is_solved
    assert [step.kind for step in plan.steps] == ["move", "fold"]
    require_replay(Plan.from_dict(plan.to_dict()))


def rest_to_rest_s(way: float, speed: float, acceleration: float) -> float:
    """Return the time of a way with an even rise to the top speed, if that is reached, and an even fall."""
    reaches_it = way >= speed**2 / acceleration
    return way / speed + speed / acceleration if reaches_it else 2.0 * math.sqrt(way / acceleration)


def test_a_move_takes_what_driving_and_turning_take_one_after_the_other(plan: Plan, scene: Scene) -> None:
    waypoints = [Pose2(*pose) for pose in plan.steps[0].details["waypoints"]]
    assert len(waypoints) > 4
    driven_m = sum(math.dist((a.x_m, a.y_m), (b.x_m, b.y_m)) for a, b in pairwise(waypoints))
    turned_rad = sum(abs(wrapped_angle(b.yaw_rad - a.yaw_rad)) for a, b in pairwise(waypoints))
    assert driven_m > 0.5 and turned_rad > math.pi / 2
    # Each leg and each turn from rest to rest, with .5 m/s2 and 1 rad/s2.
    turn_rad_s = 2.0 * RIM_M_S / TRACK_M
    expected_s = sum(
        rest_to_rest_s(math.dist((a.x_m, a.y_m), (b.x_m, b.y_m)), RIM_M_S, 0.5)
        + rest_to_rest_s(abs(wrapped_angle(b.yaw_rad - a.yaw_rad)), turn_rad_s, 1.0)
        for a, b in pairwise(waypoints)
    )
    assert plan.steps[0].duration_s == pytest.approx(expected_s)


def test_it_never_drives_sideways_nor_turns_its_wheels_too_fast(plan: Plan) -> None:
    path = trajectory(plan)
    times = np.linspace(0.0, plan.cost_s or 0.0, 4001)
    bases = np.array([(b.x_m, b.y_m, b.yaw_rad) for b in (path.segment_at(t).base_at(t) for t in times.tolist())])
    bases[:, 2] = np.unwrap(bases[:, 2])
    x, y, yaw = np.diff(bases, axis=0).T / times[1]
    heading = bases[:-1, 2]
    assert np.abs(y * np.cos(heading) - x * np.sin(heading)).max() < 2e-3  # one sample may hold a bend
    assert np.abs(yaw).max() > 0.5 and np.hypot(x, y).max() > 0.2
    assert rims_m_s(np.hypot(x, y), yaw).max() <= RIM_M_S * (1 + 1e-6)


def test_what_is_sent_to_it_rolls_too(plan: Plan, robot: str) -> None:
    require_smooth(plan, load_robot(robot).card)
    path = trajectory(plan)
    times = np.linspace(0.0, plan.cost_s or 0.0, 4001)
    (x, y, turn), heading = velocities_at(path, times)[:, -3:].T, positions_at(path, times)[:, -1]
    assert np.abs(y * np.cos(heading) - x * np.sin(heading)).max() < 1e-9
    assert rims_m_s(np.hypot(x, y), turn).max() <= RIM_M_S * (1 + 1e-6)


def test_a_plan_from_elsewhere_that_drives_sideways_is_refused(plan: Plan) -> None:
    path = trajectory(plan)
    segments = tuple(sideways(segment) for segment in path.segments)
    with pytest.raises(RequestError, match="sideways"):
        require_replay(replace(plan, trajectory=replace(path, segments=segments)))


def sideways(segment: Segment) -> Segment:
    """Return a segment in which the base looks across where it goes."""
    start, end = (Pose2(base.x_m, base.y_m, base.yaw_rad + math.pi / 2) for base in segment.phase.base)
    return replace(segment, phase=replace(segment.phase, base=(start, end)))
