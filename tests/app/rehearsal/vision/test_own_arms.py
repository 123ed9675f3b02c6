"""How far beside their places a camera and hands are, told from pictures of a robot's own arms."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.look import PLAIN
from app.rehearsal.camera.mounted import hung, overhead
from app.rehearsal.camera.picture import ClothSeen, picture
from app.rehearsal.camera.posture import Posture
from app.rehearsal.camera.robot_shape import RobotShape, robot_shape
from app.rehearsal.hand_eye import HandEye
from app.rehearsal.noisy_world import deflected
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.step_motions import posture_at
from app.rehearsal.vision.own_arms import seen_beside
from app.rehearsal.vision.picture import Image
from planner import Scene
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.woven_mesh import woven_mesh
from planner.robots.load_robot import load_robot
from tests.app.rehearsal.towel import towel_plan

CAMERA = hung(overhead(Scene().table))
EVEN = replace(PLAIN, wood=0.0, shadow=0.0)
LIKELY_M2 = 0.01**2 * np.eye(2)
SHIFTS_M = [(0.0, 0.0), (0.009, -0.004), (-0.012, 0.015)]


END_S = 99.0


def stands(t_s: float) -> Posture:
    """The robot at a time of the plan; at its end both hands are over the table."""
    path = towel_plan().trajectory
    assert path is not None
    return posture_at(path, min(t_s, path.duration_s))


def shape() -> RobotShape:
    return robot_shape(load_robot("pr2").card, -towel_plan().scene.table.height_m)


@cache
def parts(t_s: float) -> list[FloatArray]:
    return shape().parts(stands(t_s))


def hands(t_s: float) -> dict[str, list[FloatArray]]:
    return shape().hands(stands(t_s))


@cache
def taken(t_s: float, moment: int = 0) -> Image:
    return image_of(parts(t_s), moment)


def image_of(robot: list[FloatArray], moment: int = 0) -> Image:
    plan = towel_plan()
    pattern, triangles = woven_mesh(plan.garment.pattern, 0.03, 1)
    lies = plan.task.start.placement
    cloth = ClothSeen(pattern, planned_positions(plan.sequence, pattern, 0, lies, plan.scene.table, 0.002), triangles)
    return picture(CAMERA, plan.scene.table, cloth, robot, PLAIN, 3, moment)


def believed(shift_m: tuple[float, float]) -> Camera:
    return CAMERA.carried(Isometry.rotation(0.0, *shift_m))


@pytest.mark.parametrize("t_s", [0.0, 3.0, END_S])
@pytest.mark.parametrize("shift_m", SHIFTS_M)
def test_the_shift_of_a_camera_is_seen_to_a_millimetre_and_a_half(shift_m: tuple[float, float], t_s: float) -> None:
    told = seen_beside(taken(t_s), believed(shift_m), parts(t_s), [], LIKELY_M2)
    assert told is not None
    assert told.shift_m == pytest.approx(shift_m, abs=1.5e-3)
    off = told.shift_m - shift_m
    assert off @ np.linalg.solve(told.covariance_m2, off) < 9.0


def test_of_a_robot_that_is_not_in_the_picture_nothing_is_told() -> None:
    grey = np.full_like(taken(0.0), 128)
    assert seen_beside(grey, CAMERA, parts(END_S), [], LIKELY_M2) is None
    noise = np.asarray(np.random.default_rng(0).normal(128.0, 3.0, grey.shape), np.uint8)
    assert seen_beside(noise, CAMERA, parts(END_S), [], LIKELY_M2) is None
    away = [part + np.array([5.0, 0.0, 0.0]) for part in parts(END_S)]
    assert seen_beside(taken(END_S), CAMERA, away, [], LIKELY_M2) is None


def test_along_a_straight_edge_little_is_told() -> None:
    told = seen_beside(bars(box(-2.0, 2.0)), believed((0.0, 0.008)), [box(-2.0, 2.0)], [], LIKELY_M2)
    assert told is not None
    along_m, across_m = np.sqrt(np.diag(told.covariance_m2))
    assert told.shift_m[1] == pytest.approx(0.008, abs=1e-3)
    assert across_m < 2e-3 < 0.02 < along_m


def test_of_something_seen_wider_than_it_is_no_end_is_told_to_be_further_ahead() -> None:
    ahead = box(0.2, 2.0)  # its other end is not in the picture
    told = seen_beside(bars(box(0.196, 2.0, 0.034)), CAMERA, [ahead], [], LIKELY_M2)
    assert told is not None
    assert told.shift_m == pytest.approx([0.0, 0.0], abs=1.5e-3)


@pytest.mark.parametrize("near_m", [0.01, -0.01])
def test_of_two_things_that_fit_as_well_the_likelier_is_seen(near_m: float) -> None:
    two = bars(*(box(-2.0, 2.0, 0.008, y_m) for y_m in (near_m, -2.9 * near_m)))
    told = seen_beside(two, CAMERA, [box(-2.0, 2.0, 0.008)], [], LIKELY_M2)
    assert told is not None
    assert told.shift_m[1] == pytest.approx(near_m, abs=1e-3)


def box(begins_m: float, ends_m: float, half_m: float = 0.03, y_m: float = 0.0) -> FloatArray:
    """The corners of a bar along x over the table, shape (8, 3), m."""
    return np.array([[x, y_m + y, z] for x in (begins_m, ends_m) for y in (-half_m, half_m) for z in (0.1, 0.12)])


def bars(*those: FloatArray) -> Image:
    """A picture of nothing but bars."""
    away = ClothSeen(np.empty((0, 2)), np.array([[0.0, 9.0, 0.0]] * 3), np.array([[0, 1, 2]]))
    return picture(CAMERA, towel_plan().scene.table, away, [*those], EVEN, 3)


def test_what_is_learned_of_a_camera_gets_surer_and_stays_where_no_arm_is_seen() -> None:
    shift_m, hand_eye = (0.012, -0.009), HandEye()
    first = hand_eye.corrected(taken(END_S), believed(shift_m), hands(END_S))
    assert np.subtract(first.position, CAMERA.position)[:2] == pytest.approx([0.0, 0.0], abs=4e-3)
    for moment in range(1, 6):
        corrected = hand_eye.corrected(taken(END_S, moment), believed(shift_m), hands(END_S))
    learned = hand_eye.shift_m
    assert learned == pytest.approx(shift_m, abs=1.5e-3)
    assert np.subtract(corrected.position, CAMERA.position)[:2] == pytest.approx([0.0, 0.0], abs=1.5e-3)
    hand_eye.corrected(np.full_like(taken(0.0), 128), believed(shift_m), hands(END_S))
    assert hand_eye.shift_m == pytest.approx(learned) and not hand_eye.hands_m


def test_hands_beside_their_places_are_told_from_a_camera_beside_its_own() -> None:
    shift_m, hand_eye = (0.004, -0.003), HandEye()
    for moment in range(6):
        hand_eye.corrected(taken(END_S, moment), believed(shift_m), hands(END_S))
    off_m = {"left": np.array([0.006, -0.002]), "right": np.array([-0.001, 0.007])}
    really = deflected("pr2", stands(END_S), off_m)
    hand_eye.corrected(image_of(shape().parts(really), 7), believed(shift_m), hands(END_S))
    assert hand_eye.hands_m.keys() == off_m.keys()
    for name, seen_m in hand_eye.hands_m.items():
        assert seen_m == pytest.approx(off_m[name], abs=2.5e-3)
    assert hand_eye.shift_m == pytest.approx(shift_m, abs=2e-3)


def test_what_cannot_be_a_hand_is_not_taken_for_one() -> None:
    hand_eye, robot = HandEye(), hands(END_S)
    for moment in range(4):
        hand_eye.corrected(taken(END_S, moment), CAMERA, robot)
    before = hand_eye.shift_m
    gone = [part for name, parts in robot.items() for part in parts if name != "left"]
    aside = [part + np.array([0.028, 0.0, 0.0]) for part in robot["left"]]
    hand_eye.corrected(image_of([*gone, *aside], 5), CAMERA, robot)
    assert "left" not in hand_eye.hands_m and "right" in hand_eye.hands_m
    assert hand_eye.shift_m == pytest.approx(before, abs=1e-3)


def test_the_parts_of_hands_and_of_the_rest_are_all_parts() -> None:
    found = hands(END_S)
    assert set(found) == {"", "left", "right"}
    assert sum(len(those) for those in found.values()) == len(parts(END_S))
    middle = {name: np.concatenate(those).mean(axis=0) for name, those in found.items()}
    path = towel_plan().trajectory
    assert path is not None
    assert middle["left"][1] > middle["right"][1] + 0.1  # the robot stands at the table's left end and looks along x
