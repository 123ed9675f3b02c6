"""Why and by how much a point is out of reach, against the definition: displace it, and ask again."""

from dataclasses import replace

import numpy as np
import pytest

from planner.geometry.shortfall import Shortfall
from planner.robot.arm import read_arm
from planner.robot.kernel import Aim, slacks
from planner.robot.limiting_joint import JOINT_NAMES, joint_slacks
from planner.robot.pr2 import load_robot
from planner.robot.reach import APPROACHES
from planner.robot.shortfall import DIRECTIONS, FURTHEST_M
from tests.robot.model import MODEL

ROBOT = load_robot("pr2")
TORSO_M = 0.29
COMFORT_M = 0.03
TABLE_M = 0.79
EVERY_APPROACH = np.arange(len(APPROACHES))
FORWARD = np.array([19])
"""Fingers ahead, 30 degrees down."""


def test_the_approach_called_forward_is_that():
    approach = APPROACHES[FORWARD[0]]
    assert (approach.heading_rad, approach.pitch_rad) == (0.0, pytest.approx(np.pi / 6))


@pytest.mark.parametrize("approaches", [EVERY_APPROACH, FORWARD])
@pytest.mark.parametrize("arm", [0, 1])
def test_displaced_by_what_it_is_short_a_point_is_in_comfort(arm, approaches):
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    for point, found in _displaced(reach, arm, approaches):
        there = point + (found.short_by_m + 0.002) * np.array(found.towards)
        assert reach.from_anywhere(arm, there[None], np.array([found.approach]), 1, 0.0).all()


@pytest.mark.parametrize("approaches", [EVERY_APPROACH, FORWARD])
@pytest.mark.parametrize("arm", [0, 1])
def test_no_smaller_displacement_brings_a_point_into_comfort(arm, approaches):
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    for point, found in _displaced(reach, arm, approaches):
        distances = np.arange(0.0, found.short_by_m - 0.001, 0.005)
        tried = point + distances[:, None, None] * DIRECTIONS
        assert not reach.from_anywhere(arm, tried.reshape(-1, 3), approaches, 1, 0.0).any()


@pytest.mark.parametrize("comfort_m", [0.0, COMFORT_M])
@pytest.mark.parametrize("arm", [0, 1])
def test_there_is_no_shortfall_exactly_in_comfort(arm, comfort_m):
    reach = ROBOT.reach(TORSO_M, comfort_m)
    points = _points(np.random.default_rng(31), 100)
    in_comfort = reach.from_anywhere(arm, points, EVERY_APPROACH, 1, 0.0).any(axis=0)
    assert 20 < in_comfort.sum() < 80
    assert [reach.shortfall(arm, point, EVERY_APPROACH) is None for point in points] == list(in_comfort)


def test_mirror_images_are_short_by_the_same():
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    by_direction = {(a.heading_rad, a.pitch_rad): i for i, a in enumerate(APPROACHES)}
    mirrored = np.array([by_direction[-a.heading_rad, a.pitch_rad] for a in APPROACHES])
    for point in _points(np.random.default_rng(32), 60):
        left = reach.shortfall(0, point, EVERY_APPROACH)
        right = reach.shortfall(1, point * np.array([1.0, -1.0, 1.0]), mirrored)
        if left is None or right is None:
            assert left is right
            continue
        x, y, z = left.towards
        assert right == replace(left, towards=(x, -y, z), approach=int(mirrored[left.approach]))


@pytest.mark.parametrize("arm", [0, 1])
def test_only_comfort_is_missing_exactly_where_the_point_itself_is_reachable(arm):
    comfortable, bare = ROBOT.reach(TORSO_M, COMFORT_M), ROBOT.reach(TORSO_M, 0.0)
    causes = []
    for point in _points(np.random.default_rng(33), 150):
        found = comfortable.shortfall(arm, point, FORWARD)
        if found is not None:
            assert (found.cause == "comfort_only") == (bare.shortfall(arm, point, FORWARD) is None)
            causes.append(found.cause)
    assert {"comfort_only", "too_far", "too_near"} <= set(causes)


@pytest.mark.parametrize("approaches", [EVERY_APPROACH, FORWARD])
def test_what_is_short_of_comfort_is_what_the_largest_circle_lacks(approaches):
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    asked = [(p, reach.shortfall(0, p, approaches)) for p in _points(np.random.default_rng(34), 400)]
    short = [(p, found) for p, found in asked if found is not None and found.cause == "comfort_only"]
    assert len(short) >= 5
    for point, found in short:
        largest_m = COMFORT_M - found.short_by_m
        there, beyond = (ROBOT.reach(TORSO_M, radius_m) for radius_m in (largest_m, largest_m + 0.0011))
        assert there.from_anywhere(0, point[None], np.array([found.approach]), 1, 0.0).all()
        assert not beyond.from_anywhere(0, point[None], approaches, 1, 0.0).any()


def test_two_metres_ahead_is_too_far_for_any_joint():
    found = ROBOT.reach(TORSO_M, COMFORT_M).shortfall(0, np.array([2.0, 0.0, TABLE_M]), EVERY_APPROACH)
    assert found is not None
    assert (found.cause, found.joint) == ("too_far", None)
    # Shoulder to tool is at most 0.1 + 0.4 + 0.321 + 0.18 m, and the shoulder is 5 cm behind the base's middle.
    assert found.short_by_m >= max(FURTHEST_M, 2.05 - 1.001)
    assert found.towards[0] < -0.9


def test_a_little_too_far_ahead_is_short_backwards():
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    # The straight arm leads 0.901 m from the lift axis, so the wrist of a forward tool is at most at x = 0.771 m.
    found = reach.shortfall(0, np.array([1.2, 0.188, 1.0]), FORWARD)
    assert found is not None
    assert (found.cause, found.joint, found.towards[0]) == ("too_far", None, pytest.approx(-1.0))


def test_a_place_at_the_shoulders_foot_is_too_near():
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    for arm, (x, y, _) in enumerate(reach.shoulders):
        found = reach.shortfall(arm, np.array([x, y, TABLE_M]), FORWARD)
        assert found is not None
        assert found.cause == "too_near"
        assert found.joint in JOINT_NAMES


def test_a_place_high_above_is_too_far_and_must_come_down():
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    found = reach.shortfall(0, np.array([0.5, 0.188, 1.75]), FORWARD)
    assert found is not None
    assert found.cause == "too_far"
    assert found.towards[2] == -1.0


def test_far_to_the_other_side_the_shoulders_pan_limits():
    """A left arm cannot turn far to the right: its pan ends at -41 degrees."""
    found = ROBOT.reach(TORSO_M, COMFORT_M).shortfall(0, np.array([0.1, -0.75, 1.0]), np.array([13]))
    assert found is not None
    assert found.joint == "shoulder pan"


def test_the_joints_slacks_are_those_of_the_kernel():
    shape = read_arm(MODEL)
    rng = np.random.default_rng(35)
    compared = 0
    for _ in range(2000):
        axis = rng.normal(size=3)
        aim = Aim(*rng.uniform(-0.8, 0.8, 3), *(axis / np.linalg.norm(axis)))
        pan = rng.uniform(shape.pan.low, shape.pan.high)
        for branch, least in zip((1.0, -1.0), slacks(shape, aim, pan), strict=True):
            if least > -1.0:
                assert min(joint_slacks(shape, aim, pan, branch)[1:]) == pytest.approx(least, abs=1e-9)
                compared += 1
    assert compared > 300


def test_queries_and_time_are_counted():
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    reach.shortfall(0, np.array([0.0, 0.188, TABLE_M]), EVERY_APPROACH)
    assert reach.queries > len(EVERY_APPROACH)
    assert reach.query_time_s > 0.0


def test_asking_in_no_approach_is_refused():
    with pytest.raises(ValueError, match="approach"):
        ROBOT.reach(TORSO_M, COMFORT_M).shortfall(0, np.zeros(3), np.array([], dtype=int))


@pytest.mark.parametrize(
    "wrong",
    [{"cause": "tired"}, {"short_by_m": np.inf}, {"short_by_m": -0.1}, {"towards": (1.0, 1.0, 0.0)}],
)
def test_a_shortfall_that_is_none_is_refused(wrong):
    right = {"cause": "too_far", "joint": None, "short_by_m": 0.1, "towards": (1.0, 0.0, 0.0), "approach": 0}
    assert Shortfall(**right)
    with pytest.raises(ValueError, match=r"no cause|short by|direction"):
        Shortfall(**{**right, **wrong})


def _points(rng: np.random.Generator, count: int) -> np.ndarray:
    """Places over a table and around it, on the grid of the queries (m)."""
    return np.round(rng.uniform((-0.2, -0.8, 0.7), (1.3, 0.8, 1.3), (count, 3)), 5)


def _displaced(reach, arm: int, approaches: np.ndarray) -> list[tuple[np.ndarray, Shortfall]]:
    """Points out of reach for which a displacement that helps was found."""
    asked = [(point, reach.shortfall(arm, point, approaches)) for point in _points(np.random.default_rng(30), 60)]
    found = [(p, f) for p, f in asked if f is not None and f.cause != "comfort_only" and f.short_by_m < FURTHEST_M]
    assert len(found) >= 15
    return found
