"""A camera beside where it is believed to be, told from pictures of a robot's own arms."""

from functools import cache

import numpy as np
import pytest

from app.camera.camera import Camera
from app.camera.look import PLAIN
from app.camera.mounted import hung, overhead
from app.camera.picture import ClothSeen, picture
from app.camera.robot_shape import robot_shape
from app.rehearsal.hand_eye import HandEye
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.step_motions import posture_at
from app.vision.own_arms import seen_beside
from app.vision.picture import Image
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.woven_mesh import woven_mesh
from planner.robots.load_robot import load_robot
from tests.app.rehearsal.towel import towel_plan

CAMERA = hung(overhead(towel_plan().scene.table))
SHIFTS_M = [(0.0, 0.0), (0.009, -0.004), (-0.012, 0.015)]


@cache
def parts(t_s: float) -> list[FloatArray]:
    """The robot at a time of the plan; at its end both hands are over the table."""
    path = towel_plan().trajectory
    assert path is not None
    table = towel_plan().scene.table
    return robot_shape(load_robot("pr2").card, -table.height_m).parts(posture_at(path, min(t_s, path.duration_s)))


@cache
def taken(t_s: float, moment: int = 0) -> Image:
    plan = towel_plan()
    pattern, triangles = woven_mesh(plan.garment.pattern, 0.03, 1)
    lies = plan.task.start.placement
    cloth = ClothSeen(pattern, planned_positions(plan.sequence, pattern, 0, lies, plan.scene.table, 0.002), triangles)
    return picture(CAMERA, plan.scene.table, cloth, parts(t_s), PLAIN, 3, moment)


def believed(shift_m: tuple[float, float]) -> Camera:
    return CAMERA.carried(Isometry.rotation(0.0, *shift_m))


@pytest.mark.parametrize("t_s", [0.0, 3.0, 99.0])
@pytest.mark.parametrize("shift_m", SHIFTS_M)
def test_the_shift_of_a_camera_is_seen_to_a_millimetre_and_a_half(shift_m: tuple[float, float], t_s: float):
    told = seen_beside(taken(t_s), believed(shift_m), parts(t_s))
    assert told is not None
    assert told.shift_m == pytest.approx(shift_m, abs=1.5e-3)
    off = told.shift_m - shift_m
    assert off @ np.linalg.solve(told.covariance_m2, off) < 9.0


def test_of_a_robot_that_is_not_in_the_picture_nothing_is_told():
    grey = np.full_like(taken(0.0), 128)
    assert seen_beside(grey, CAMERA, parts(99.0)) is None
    noise = np.asarray(np.random.default_rng(0).normal(128.0, 3.0, grey.shape), np.uint8)
    assert seen_beside(noise, CAMERA, parts(99.0)) is None
    away = [part + np.array([5.0, 0.0, 0.0]) for part in parts(99.0)]
    assert seen_beside(taken(99.0), CAMERA, away) is None


def test_along_a_straight_edge_little_is_told():
    bar = np.array([[x, y, z] for x in (-2.0, 2.0) for y in (-0.03, 0.03) for z in (0.1, 0.12)])
    plan = towel_plan()
    away = ClothSeen(np.empty((0, 2)), np.array([[0.0, 9.0, 0.0]] * 3), np.array([[0, 1, 2]]))
    image = picture(CAMERA, plan.scene.table, away, [bar], PLAIN, 3)
    told = seen_beside(image, believed((0.0, 0.008)), [bar])
    assert told is not None
    along_m, across_m = np.sqrt(np.diag(told.covariance_m2))
    assert told.shift_m[1] == pytest.approx(0.008, abs=1e-3)
    assert across_m < 2e-3 < 0.02 < along_m


def test_what_is_learned_of_a_camera_gets_surer_and_stays_where_no_arm_is_seen():
    shift_m, hand_eye = (0.012, -0.009), HandEye()
    first = hand_eye.corrected(taken(99.0), believed(shift_m), parts(99.0))
    assert np.subtract(first.position, CAMERA.position)[:2] == pytest.approx([0.0, 0.0], abs=2.5e-3)
    for moment in range(1, 6):
        corrected = hand_eye.corrected(taken(99.0, moment), believed(shift_m), parts(99.0))
    learned = hand_eye.shift_m
    assert learned == pytest.approx(shift_m, abs=1e-3)
    assert np.subtract(corrected.position, CAMERA.position)[:2] == pytest.approx([0.0, 0.0], abs=1e-3)
    hand_eye.corrected(np.full_like(taken(0.0), 128), believed(shift_m), parts(99.0))
    assert hand_eye.shift_m == pytest.approx(learned)
