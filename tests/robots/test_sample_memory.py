"""The memory of the samples at tool poses: it answers as what samples the poses does, and asks it for new ones only."""

import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.robots.mapped_arm import SampleMemory

JOINTS = 5


class Sampler:
    """Samples that depend on the pose alone, some poses having none; counts the poses asked."""

    def __init__(self) -> None:
        self.asked = 0

    def __call__(self, points: FloatArray, rotations: FloatArray, floor: float) -> tuple[FloatArray, FloatArray]:
        self.asked += len(points)
        joints, costs = np.zeros((len(points), 9, JOINTS)), np.full((len(points), 9), np.inf)
        for number, point in enumerate(points):
            taken = int(point[0])
            joints[number, :taken] = point[1] + rotations[number, 0, 0] + np.arange(taken)[:, None]
            costs[number, :taken] = floor + np.arange(taken)
        most = max(1, int(np.isfinite(costs).sum(axis=1).max()))
        return joints[:, :most], costs[:, :most]


def poses(*samples: int) -> tuple[FloatArray, FloatArray]:
    return np.array([[count, 0.1 * count, 0.0] for count in samples], dtype=float), np.array([np.eye(3)] * len(samples))


def same(left: tuple[FloatArray, FloatArray], right: tuple[FloatArray, FloatArray]) -> None:
    for one, other in zip(left, right, strict=True):
        np.testing.assert_array_equal(one, other)


def test_it_answers_as_the_sampler_and_asks_it_once_for_each_pose() -> None:
    sampler = Sampler()
    memory = SampleMemory(sampler)
    for asked in ((3, 0, 8), (8, 8, 2, 3), (0,), (2, 0)):
        same(memory.samples(*poses(*asked), 0.5), Sampler()(*poses(*asked), 0.5))
    assert sampler.asked == 4


@pytest.mark.parametrize("other", ["floor", "rotation"])
def test_another_floor_or_rotation_is_another_question(other: str) -> None:
    sampler = Sampler()
    memory = SampleMemory(sampler)
    points, rotations = poses(4)
    memory.samples(points, rotations, 0.0)
    turned, floor = (-rotations, 0.0) if other == "rotation" else (rotations, 1.0)
    same(memory.samples(points, turned, floor), Sampler()(points, turned, floor))
    assert sampler.asked == 2


def test_what_the_caller_does_to_an_answer_is_not_remembered() -> None:
    memory = SampleMemory(Sampler())
    _, costs = memory.samples(*poses(4), 0.0)
    costs[:] = np.inf
    same(memory.samples(*poses(4), 0.0), Sampler()(*poses(4), 0.0))


def test_poses_asked_longest_ago_are_forgotten_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("planner.robots.mapped_arm._POSES_KEPT", 2)
    sampler = Sampler()
    memory = SampleMemory(sampler)
    for asked, times in ((1, 1), (2, 2), (1, 2), (3, 3), (1, 3), (2, 4)):
        memory.samples(*poses(asked), 0.0)
        assert sampler.asked == times
    memory.forget()
    memory.samples(*poses(2), 0.0)
    assert sampler.asked == 5
