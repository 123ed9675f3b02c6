"""The camera that follows the work never has the robot between itself and the hands, and comes to where the work is."""

import math

import numpy as np
import pytest

from app.ui.viewpoints.following import Following, work_of
from app.ui.viewpoints.presets import Lens
from planner import Plan
from planner.geometry.pose import Point2, Point3, Pose2, wrapped_angle
from tests.replay.planned import shipped_plan

LENS = Lens(1.5)
WORK = [(0.0, 0.0), (-0.6, 0.2), (0.3, -0.4)]
BASES = [Pose2(-0.95, 0.0, 0.0), Pose2(-0.4, 0.75, -math.pi / 2), Pose2(0.4, -0.75, math.pi / 2)]


@pytest.mark.parametrize("work", WORK)
@pytest.mark.parametrize("base", BASES)
def test_the_robot_is_never_between_camera_and_work(base: Pose2, work: tuple[float, float]) -> None:
    (x, y, z), look_at, _ = _parts(Following(), base, work)
    assert look_at[:2] == pytest.approx(work)
    to_camera = math.atan2(y - work[1], x - work[0])
    to_robot = math.atan2(base.y_m - work[1], base.x_m - work[0])
    assert abs(wrapped_angle(to_camera - to_robot)) > math.radians(120)
    assert z > 0.5


def test_the_camera_goes_after_the_work_without_a_jump() -> None:
    following = Following()
    before = np.array(following.view(BASES[0], WORK[0], LENS).position)
    for _ in range(120):
        now = np.array(following.view(BASES[1], WORK[2], LENS).position)
        assert np.linalg.norm(now - before) < 0.6
        before = now
    assert now == pytest.approx(Following().view(BASES[1], WORK[2], LENS).position, abs=0.01)


def test_the_work_is_where_the_hands_are_and_at_the_end_on_the_packet() -> None:
    plan: Plan = shipped_plan("hand-towel")
    for step in plan.steps:
        if step.grips:
            points = np.array([point[:2] for grip in step.grips for point in (grip.pick, grip.place)])
            assert work_of(plan, step.start_s) == pytest.approx(tuple(points.mean(axis=0)))
    assert plan.cost_s is not None and plan.final_placement is not None
    corners = np.array([point for layer in plan.final_layers for point in layer.region.coordinates])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    assert work_of(plan, plan.cost_s) == pytest.approx(tuple(plan.final_placement.to_outer(middle[None])[0]))


def _parts(following: Following, base: Pose2, work: Point2) -> tuple[Point3, Point3, float]:
    seen = following.view(base, work, LENS)
    return seen.position, seen.look_at, seen.fov_rad
