"""Cameras that hang over a table or are carried by a robot."""

import numpy as np
import pytest

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.mounted import camera_of, wrists
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import robot_shape
from planner.geometry.pose import Pose2
from planner.robots.load_robot import load_robot, robot_card_file


@pytest.mark.parametrize("robot", ["so101-pair", "pr2"])
def test_a_wrists_camera_looks_at_the_fingertips_from_above_with_the_fingers_side_by_side(robot: str) -> None:
    card, file = load_robot(robot).card, robot_card_file(robot)
    shape, home = robot_shape(card, -0.75), card.home_values(file.scene.torso_m)
    posture = Posture(Pose2(-0.4, 0.1, 0.7), home)
    cameras = wrists(file, shape, home, (160, 120))
    assert list(cameras) == [arm.name for arm in card.arms]
    for arm in file.arms:
        frame, camera = shape.frames(posture)[arm.tool.link], camera_of(cameras[arm.name], shape, posture)
        tip = frame[:3, :3] @ arm.tool.offset_m + frame[:3, 3]
        aside = tip + 0.02 * frame[:3, :3] @ np.array(arm.tool.closing)
        (x, y), (x_aside, y_aside) = camera.pixels(np.array([tip, aside]))
        assert (x, y) == pytest.approx((79.5, 59.5), abs=1e-6)
        assert abs(x_aside - x) > 10.0 and y_aside == pytest.approx(y, abs=1.0)
        assert camera.position[2] > tip[2]


def test_all_pixels_at_once_meet_the_table_where_each_does() -> None:
    low = np.array([[1.0, 0.0, 0.0, 0.1], [0.0, -0.2, 0.98, -0.3], [0.0, -0.98, -0.2, 0.4], [0.0, 0.0, 0.0, 1.0]])
    camera = Camera.at(low, (16, 12), 1.2)
    rows, columns = np.mgrid[:12, :16]
    each = camera.on_plane(np.column_stack([columns.ravel(), rows.ravel()]).astype(float))
    x, y = camera.all_on_table()
    np.testing.assert_allclose(np.column_stack([x.ravel(), y.ravel()]), each, rtol=1e-5)
    assert 0 < np.isnan(x).sum() < x.size, "it sees the horizon"
