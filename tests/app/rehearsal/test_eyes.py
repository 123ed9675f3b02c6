"""A towel in rendered pictures: found where it lies, doubted where arms hide it, and then looked at again."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from app.camera.posture import Posture
from app.rehearsal.camera_world import CameraWorld
from app.rehearsal.judge import Gate
from app.rehearsal.perform import Performer
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.replay_world import Recorded, ReplayWorld
from app.rehearsal.step_motions import posture_at
from app.rehearsal.world import WITHDRAW, Observation, Performed, StepMotion, Truth
from planner import Plan, Task
from planner.geometry.isometry import Isometry
from planner.geometry.woven_mesh import woven_mesh
from tests.app.rehearsal.towel import towel_plan

INWARDS_RAD = 0.15


class FlatCloth:
    """A towel that lies flat somewhere, and notes what it is asked for."""

    def __init__(self, dx_m: float, dy_m: float) -> None:
        plan = towel_plan()
        lies = plan.task.start.placement.moved(dx_m, dy_m)
        pattern, triangles = woven_mesh(plan.garment.pattern, 0.03, 1)
        positions = planned_positions(plan.sequence, pattern, 0, lies, plan.scene.table, 0.002)
        self.asked: list[StepMotion] = []
        self._truth = Truth(pattern, positions, triangles)

    def observe(self) -> Observation:
        return Observation()

    def perform(self, motion: StepMotion) -> Performed:
        self.asked.append(motion)
        return Performed({grip.arm: True for grip in motion.grips})

    def truth(self) -> Truth:
        return self._truth


@cache
def home() -> Posture:
    path = towel_plan().trajectory
    assert path is not None
    return posture_at(path, 0.0)


def over_the_cloth() -> Posture:
    """The posture of the end of the plan, but with the arms turned inwards: upper arms and forearms hide the cloth."""
    path = towel_plan().trajectory
    assert path is not None
    ends = posture_at(path, path.duration_s)
    return replace(
        ends, joints={**ends.joints, "l_shoulder_pan_joint": INWARDS_RAD, "r_shoulder_pan_joint": -INWARDS_RAD}
    )


def no_plan(task: Task) -> Plan:
    raise AssertionError(f"nobody should plan again from {task.start}")


def test_the_same_moment_is_the_same_picture_and_the_next_has_other_noise():
    one, other = (CameraWorld(FlatCloth(0.0, 0.0), towel_plan().task, home(), 3) for _ in range(2))
    first, again = one.observe().image, other.observe().image
    later = one.observe().image
    assert first is not None and again is not None and later is not None
    assert first.shape == (480, 640, 3)
    np.testing.assert_array_equal(first, again)
    assert 0 < np.abs(first.astype(int) - later).mean() < 10


def test_grips_follow_cloth_that_a_camera_sees_two_centimetres_away():
    cloth = FlatCloth(0.012, -0.016)
    world = CameraWorld(cloth, towel_plan().task, home(), 3)
    done = Performer(towel_plan(), world, Gate(), no_plan).performed()
    (corrected,) = (one for one in done.decisions if one.code == "corrected")
    assert dict(corrected.numbers)["shift_m"] == pytest.approx(0.02, abs=4e-3)
    (picture,) = done.pictures
    assert picture.sight.unknown is None and len(picture.jpeg) < 60_000
    assert not picture.is_clear


def test_arms_in_front_of_the_cloth_are_withdrawn_for_another_look():
    cloth = FlatCloth(0.0, 0.0)
    world = CameraWorld(cloth, towel_plan().task, over_the_cloth(), 3)
    performer = Hindered(towel_plan(), world, Gate(), no_plan)
    done = performer.performed()
    assert [picture.is_clear for picture in done.pictures] == [False, True]
    assert done.pictures[-1].sight.unknown is None
    assert [motion.kind for motion in cloth.asked] == [WITHDRAW, "fold"]


class Hindered(Performer):
    """Begins with a robot whose arms are over the cloth."""

    def _begins(self) -> Posture:
        return over_the_cloth()


def test_a_run_that_stays_blind_ends_with_the_reason_and_the_picture():
    grey = Observation(
        np.full((480, 640, 3), 128, np.uint8),
        CameraWorld(FlatCloth(0.0, 0.0), towel_plan().task, home(), 3).observe().camera,
    )
    world = ReplayWorld(grey, [Recorded(Performed(), grey) for _ in range(4)])
    performer = Performer(towel_plan(), world, Gate(), no_plan)
    performer._blind = 1
    done = performer.performed()
    assert "not to be made out" in done.reason
    assert [decision.code for decision in done.decisions] == ["not_known", "not_known", "kept_blindly"]
    assert len(done.pictures) == 2


def test_one_step_is_made_blindly():
    camera = CameraWorld(FlatCloth(0.0, 0.0), towel_plan().task, home(), 3).observe().camera
    grey = Observation(np.full((480, 640, 3), 128, np.uint8), camera)
    world = ReplayWorld(grey, [Recorded(Performed(), grey) for _ in range(2)])
    done = Performer(towel_plan(), world, Gate(), no_plan).performed()
    assert not done.reason
    assert [decision.code for decision in done.decisions][-1] == "corrected"


def test_a_camera_carried_along_sees_the_same_point_where_the_frame_went():
    camera = CameraWorld(FlatCloth(0.0, 0.0), towel_plan().task, home(), 3).observe().camera
    assert camera is not None
    moved = Isometry.rotation(0.3, 0.05, -0.02)
    points = np.array([[0.2, 0.1], [-0.4, 0.3]])
    there = camera.carried(moved).pixels(np.column_stack([moved.apply(points), [0.1, 0.0]]))
    assert there == pytest.approx(camera.pixels(np.column_stack([points, [0.1, 0.0]])))
    assert camera.on_plane(camera.pixels(np.column_stack([points, [0.1, 0.1]])), 0.1) == pytest.approx(points)
    assert math.isclose(camera.depths(np.array([[0.0, 0.0, 0.5]]))[0], 1.5)
