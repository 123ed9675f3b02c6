"""Hands that are beside where the robot believes them to be, and are aimed by what it sees."""

from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.camera_world import CameraWorld
from app.rehearsal.corrections import aimed
from app.rehearsal.judge import Gate
from app.rehearsal.noise import Noise
from app.rehearsal.noisy_world import NoisyWorld
from app.rehearsal.perform import Performer
from app.rehearsal.step_motions import step_motions
from tests.app.rehearsal.flat_cloth import FlatCloth, home, no_plan
from tests.app.rehearsal.towel import towel_plan


def test_hands_that_are_seen_beside_their_places_close_where_they_should() -> None:
    plan, cloth = towel_plan(), FlatCloth(0.0, 0.0)
    noisy = NoisyWorld(CameraWorld(cloth, plan.task, home(), 3), Noise(arm_m=0.006), 2, plan.task)
    done = Performer(plan, noisy, Gate(), no_plan).performed()
    assert [one.code for one in done.decisions] == ["seen", "corrected", "aimed"]
    (planned,), (asked,) = step_motions(plan), (one for one in cloth.asked if one.kind == "fold")
    for grip, former in zip(asked.grips, planned.grips, strict=True):  # both hands are 12 mm beside their places
        assert np.linalg.norm(np.subtract(grip.points[0], former.points[0])) < 0.004
    assert dict(done.decisions[-1].numbers)["beside_m"] == pytest.approx(0.012, abs=0.003)


def test_a_hand_that_holds_on_begins_where_it_was_seen_to_be_and_ends_as_asked() -> None:
    (fold,) = step_motions(towel_plan())
    held = replace(fold, grips=tuple(replace(grip, closes=False) for grip in fold.grips))
    hands = {"left": (0.004, -0.002)}
    for motion, last in ((fold, (0.004, -0.002)), (held, (0.0, 0.0))):
        for grip, former in zip(aimed(motion, hands).grips, motion.grips, strict=True):
            (begins, ends) = (np.subtract(former.points[k], grip.points[k])[:2] for k in (0, -1))
            assert begins == pytest.approx(hands.get(grip.arm, (0.0, 0.0)))
            assert ends == pytest.approx(last if grip.arm in hands else (0.0, 0.0), abs=1e-9)
