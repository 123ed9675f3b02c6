import math
from dataclasses import replace

import numpy as np
import pytest

from app.ui.viewpoint import FOV_RAD
from app.ui.viewpoints.presets import Ground, Lens, robots_eye, side, top
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.robots.load_robot import load_robot

GROUND = Ground((-0.8, -0.5), (0.8, 0.5))
RIGHT_ANGLE = math.pi / 2
"""A field of view of 90 degrees sees as far to each side as it is away."""


def test_a_wide_picture_has_the_tables_length_across() -> None:
    seen = top(GROUND, Lens(1.6, RIGHT_ANGLE))
    assert seen.position[2] == pytest.approx(1.12 * 0.5)  # 0.5 m to each side upwards, 0.8 m across
    assert seen.position[0] == seen.look_at[0] == 0.0
    assert seen.position[1] < 0.0  # from a little nearer to y < 0, so that y points up in the picture


def test_a_tall_picture_has_the_tables_length_upwards() -> None:
    seen = top(GROUND, Lens(0.625, RIGHT_ANGLE))
    assert seen.position[2] == pytest.approx(1.12 * 0.8)
    assert seen.position[0] < 0.0 and seen.position[1] == 0.0


def test_the_whole_ground_is_in_a_square_picture() -> None:
    assert top(GROUND, Lens(1.0, RIGHT_ANGLE)).position[2] == pytest.approx(1.12 * 0.8)


@pytest.mark.parametrize("aspect", [0.7, 1.0, 2.0])
def test_from_the_side_the_near_edge_is_seen_from_end_to_end(aspect: float) -> None:
    x, y, _ = side(Lens(aspect, RIGHT_ANGLE), Table()).position
    near_edge_m = abs(y) - Table().width_m / 2
    for end in (-Table().depth_m / 2, Table().depth_m / 2):
        assert abs(end - x) < aspect * near_edge_m


def test_the_robots_eye_is_above_its_base_and_looks_ahead() -> None:
    # The PR2's URDF, along the base, the torso, the neck, the head, its top: -0.050 - 0.017 + 0.068 + 0.023 = 0.024 m
    # ahead of the base and, with the torso down, 0.051 + 0.740 + 0.381 + 0.065 = 1.237 m up.
    card, corners = load_robot("pr2").card, [(-0.5, 0.0), (-0.3, 0.2)]
    seen = robots_eye(card, Pose2(-0.95, 0.0, 0.0), corners, 1.0, torso_m=0.2, floor_z_m=-0.79)
    assert seen.position == pytest.approx((-0.95 + 0.024 + 0.15, 0.0, 1.237 + 0.2 - 0.79), abs=1e-3)
    assert seen.look_at == pytest.approx((-0.4, 0.1, 0.0))
    turned = robots_eye(card, Pose2(0.0, 1.0, -math.pi / 2), [(0.0, 0.0)], 1.0, torso_m=0.2, floor_z_m=-0.79)
    assert turned.position[:2] == pytest.approx((0.0, 1.0 - 0.174), abs=1e-3)
    assert turned.fov_rad == FOV_RAD


def test_a_robot_without_a_head_looks_from_a_persons_height_over_its_base() -> None:
    headless = replace(load_robot("pr2").card, eye_frame=None)
    seen = robots_eye(headless, Pose2(-0.95, 0.2, 0.0), [(-0.4, 0.2)], 1.0, torso_m=0.2, floor_z_m=-0.79)
    assert seen.position == pytest.approx((-0.95 + 0.15, 0.2, 1.4 - 0.79))


@pytest.mark.parametrize("aspect", [1.0, 1.5, 2.0])
def test_the_robots_eye_sees_all_of_a_wide_shirt(aspect: float) -> None:
    corners = [(-0.75, -0.6), (-0.75, 0.6), (0.1, 0.6), (0.1, -0.6)]
    base = Pose2(-0.95, 0.0, 0.0)
    seen = robots_eye(load_robot("pr2").card, base, corners, aspect, torso_m=0.2, floor_z_m=-0.79)
    eye = np.array(seen.position)
    ahead = (seen.look_at - eye) / np.linalg.norm(seen.look_at - eye)
    upwards = np.cross((0.0, -1.0, 0.0), ahead)  # it looks along x: right is -y
    rays = np.array([(*corner, 0.0) for corner in corners]) - eye
    depth = rays @ ahead
    assert (depth > 0.0).all()
    assert np.abs(rays @ upwards / depth).max() < math.tan(seen.fov_rad / 2)
    assert np.abs(rays[:, 1] / depth).max() < aspect * math.tan(seen.fov_rad / 2)
    assert FOV_RAD < seen.fov_rad < 2.0
