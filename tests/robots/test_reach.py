"""The robot's reach, against forward kinematics and against single queries."""

from collections.abc import Iterator

import numpy as np
import pytest

from planner.errors import RequestError, SceneError
from planner.geometry.pose import Approach, FloatArray
from planner.geometry.reach_query import ReachQuery
from planner.robots import comfort, comfort_reach
from planner.robots.comfort_reach import Memories
from planner.robots.pr2.arm import read_arm
from planner.robots.pr2.mirrored_arm import MirroredArm
from planner.robots.pr2.reach import APPROACHES, Pr2Reach
from tests.robots.model import MODEL, can_reach, joints_near, limits, pin_tool_pose, random_joints, the_pr2

ROBOT = the_pr2()
CARD = ROBOT.card
TORSO_M = 0.29
STEP_M = 0.05
COUNT = 17
EVERY_APPROACH = np.arange(len(APPROACHES))


def bodiless(comfort_m: float, memories: Memories | None = None) -> Pr2Reach:
    """Return the reach of the arms alone, with no body in their way: the naive loop finds the same."""
    arms = tuple(MirroredArm(read_arm(MODEL), is_mirrored) for is_mirrored in (False, True))
    return Pr2Reach(("left", "right"), arms, TORSO_M, comfort_m, memories=memories)


def test_there_is_a_fan_of_approaches_at_four_pitches_and_one_straight_down() -> None:
    assert len(APPROACHES) == 4 * 15 + 1
    assert [approach for approach in APPROACHES if approach.is_vertical] == [Approach(0.0, np.pi / 2)]


@pytest.mark.parametrize("arm", [0, pytest.param(1, marks=pytest.mark.long)])
def test_every_pose_of_a_configuration_within_limits_is_reachable(arm: int) -> None:
    rng = np.random.default_rng(11)
    poses = [ROBOT.tool_pose(arm, random_joints(CARD, arm, rng), TORSO_M) for _ in range(20_000)]
    positions, rotations = (np.array(part) for part in zip(*poses, strict=True))
    answers = can_reach(ROBOT, arm, positions, rotations, TORSO_M)
    assert answers.mean() >= 0.9995
    for i in np.flatnonzero(~answers):
        around = positions[i] + 0.01 * np.vstack((np.eye(3), -np.eye(3)))
        assert not can_reach(ROBOT, arm, around, np.repeat(rotations[i : i + 1], 6, axis=0), TORSO_M).all()


@pytest.mark.parametrize("arm", [0, 1])
def test_everything_reachable_has_joints_within_limits_that_reach_it(arm: int) -> None:
    rng = np.random.default_rng(12)
    positions = rng.uniform((-0.2, -1.1, 0.2), (1.0, 1.1, 1.8), (4000, 3))
    rotations = np.array([_random_rotation(rng) for _ in positions])
    answers = can_reach(ROBOT, arm, positions, rotations, TORSO_M)
    assert 300 < answers.sum() < 2000
    low, high = limits(CARD, arm)
    for position, rotation in zip(positions[answers], rotations[answers], strict=True):
        joints = joints_near(ROBOT, arm, position, rotation, TORSO_M, ROBOT.home(arm))
        assert joints is not None
        assert np.all((low <= joints) & (joints <= high))
        reached, turned = pin_tool_pose(CARD, arm, joints, TORSO_M)
        assert max(abs(reached - position).max(), abs(turned - rotation).max()) < 1e-6


def test_mirrored_questions_have_the_same_answer() -> None:
    rng = np.random.default_rng(13)
    mirror = np.array([1.0, -1.0, 1.0])
    positions = rng.uniform((0.1, -0.9, 0.5), (1.0, 0.9, 1.5), (5000, 3))
    rotations = np.array([_random_rotation(rng) for _ in positions])
    left = can_reach(ROBOT, 0, positions, rotations, TORSO_M)
    right = can_reach(ROBOT, 1, positions * mirror, mirror[:, None] * rotations * mirror, TORSO_M)
    np.testing.assert_array_equal(left, right)


def test_rolling_the_tool_about_its_axis_changes_nothing() -> None:
    rng = np.random.default_rng(14)
    positions = rng.uniform((0.1, -0.9, 0.5), (1.0, 0.9, 1.5), (2000, 3))
    rotations = np.array([_random_rotation(rng) for _ in positions])
    rolled = rotations[:, :, [0, 2, 1]] * np.array([1.0, 1.0, -1.0])
    np.testing.assert_array_equal(
        can_reach(ROBOT, 0, positions, rotations, TORSO_M), can_reach(ROBOT, 0, positions, rolled, TORSO_M)
    )


@pytest.mark.parametrize("comfort_m", [0.0, 0.03])
@pytest.mark.parametrize("arm", [0, 1])
def test_standoffs_are_what_the_naive_loop_finds(arm: int, comfort_m: float) -> None:
    asked = bodiless(comfort_m)
    for points in _paths(np.random.default_rng(15)):
        masks = asked.standoffs(ReachQuery(arm, points, EVERY_APPROACH, COUNT))
        np.testing.assert_array_equal(masks, _naive_masks(arm, points, comfort_m))
        again = asked.standoffs(ReachQuery(arm, points, EVERY_APPROACH, COUNT))
        np.testing.assert_array_equal(masks, again)


@pytest.mark.parametrize("arm", [0, pytest.param(1, marks=pytest.mark.long)])
def test_standoffs_that_matter_are_what_the_naive_loop_finds_among_them(arm: int) -> None:
    rng, able = np.random.default_rng(21), 0
    for points in _paths(rng):
        among = rng.integers(1, 1 << COUNT, len(points), dtype=np.uint32) | np.uint32(1 << COUNT // 2)
        for end in range(COUNT):
            asked = bodiless(0.03)
            masks = asked.standoffs(ReachQuery(arm, points, EVERY_APPROACH, COUNT), end=end, among=among)
            expected = _naive_masks(arm, points, 0.03, among)
            expected[(expected[:, -1:] >> end & 1 == 0)[:, 0]] = 0
            np.testing.assert_array_equal(masks, expected)
            able += int(np.count_nonzero(masks[:, 0]))
    assert able > 0


@pytest.mark.parametrize("comfort_m", [0.0, 0.03])
@pytest.mark.parametrize("arm", [0, 1])
def test_from_anywhere_is_what_the_naive_loop_finds(arm: int, comfort_m: float) -> None:
    asked = bodiless(comfort_m)
    points = np.vstack(list(_paths(np.random.default_rng(20))))
    few = 3
    expected = _naive_comfort(arm, points, comfort_m)[:, :, :few].any(axis=2)
    assert expected.any() and not expected.all()
    np.testing.assert_array_equal(asked.from_anywhere(ReachQuery(arm, points, EVERY_APPROACH, few)), expected)
    queries = asked.memory.queries
    assert queries > 0
    np.testing.assert_array_equal(asked.from_anywhere(ReachQuery(arm, points, EVERY_APPROACH, few)), expected)
    assert asked.memory.queries == queries


def test_from_anywhere_and_standoffs_share_what_they_remember() -> None:
    asked = bodiless(0.03)
    point = np.array([[0.3, 0.1, 0.9]])
    masks = asked.standoffs(ReachQuery(0, point, EVERY_APPROACH, COUNT))
    queries = asked.memory.queries
    anywhere = asked.from_anywhere(ReachQuery(0, point, EVERY_APPROACH, COUNT))
    np.testing.assert_array_equal(anywhere, masks != 0)
    assert asked.memory.queries == queries


def test_what_was_asked_before_is_not_queried_again() -> None:
    asked = bodiless(0.03)
    points = next(_paths(np.random.default_rng(16)))
    asked.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT))
    queries = asked.memory.queries
    assert queries > 0
    assert asked.memory.query_time_s > 0.0
    asked.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT))
    assert asked.memory.queries == queries


def test_the_right_arm_profits_from_what_the_left_one_was_asked() -> None:
    asked = bodiless(0.03)
    points = next(_paths(np.random.default_rng(17)))
    left = asked.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT))
    queries = asked.memory.queries
    by_direction = {(a.heading_rad, a.pitch_rad): i for i, a in enumerate(APPROACHES)}
    mirrored = np.array([by_direction[-a.heading_rad, a.pitch_rad] for a in APPROACHES])
    right = asked.standoffs(ReachQuery(1, points * np.array([1.0, -1.0, 1.0]), mirrored, COUNT))
    np.testing.assert_array_equal(left, right)
    assert asked.memory.queries == queries


def test_a_plan_answers_from_what_another_has_asked_and_is_charged_as_if_it_were_the_first() -> None:
    memories, paths = Memories(), list(_paths(np.random.default_rng(19)))
    first, fresh = bodiless(0.03, memories), bodiless(0.03)
    expected = [first.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT)) for points in paths]
    queries = first.memory.queries
    first.memory.forget()
    assert first.memory.queries == queries
    again = bodiless(0.03, memories)
    assert again.memory.queries == 0
    for points, masks in zip(paths, expected, strict=True):
        np.testing.assert_array_equal(again.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT)), masks)
        fresh.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT))
    assert again.memory.queries == fresh.memory.queries == queries
    again.memory.forget()
    left = memories.take()
    assert left.counts[comfort.ROWS] > 0 and not left.bits[:, comfort.KNOWN].any()
    assert left.bits[:, comfort.TESTED].any()


def test_plans_made_at_once_have_memories_of_their_own() -> None:
    memories = Memories()
    one, other = memories.take(), memories.take()
    assert one.keys is not other.keys
    memories.leave(one)
    assert memories.take().keys is one.keys and memories.take().keys is not other.keys


def test_a_full_memory_changes_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    usual = bodiless(0.03)
    tiny = comfort.empty_memory(size_bits=2)
    monkeypatch.setattr(comfort_reach, "empty_memory", lambda: tiny)
    forgetful = bodiless(0.03)
    for points in _paths(np.random.default_rng(18)):
        np.testing.assert_array_equal(
            forgetful.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT)),
            usual.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT)),
        )


def test_no_points_have_no_standoffs() -> None:
    masks = bodiless(0.0).standoffs(ReachQuery(0, np.empty((0, 3)), EVERY_APPROACH, COUNT))
    assert masks.shape == (len(APPROACHES), 0)


def test_what_cannot_be_asked_is_refused() -> None:
    with pytest.raises(SceneError, match="torso_m"):
        ROBOT.reach(0.5, 0.03)
    with pytest.raises(RequestError, match="comfort_radius_m"):
        ROBOT.reach(0.1, -0.01)
    with pytest.raises(ValueError, match="33"):
        ROBOT.reach(0.1, 0.0).standoffs(ReachQuery(0, np.zeros((1, 3)), EVERY_APPROACH, 33))


def test_a_standoff_beyond_a_gap_does_not_count() -> None:
    """The base cannot drive through a place from which the tool, resting, is out of reach."""
    asked = bodiless(0.0)
    for points in _paths(np.random.default_rng(19)):
        shifted = points + np.array([0.4, 0.0, 0.0])
        path = np.vstack([points[:1], shifted[-1:]])
        free = asked.standoffs(ReachQuery(0, shifted[-1:], EVERY_APPROACH, COUNT))[:, 0]
        start = asked.standoffs(ReachQuery(0, points[:1], EVERY_APPROACH, COUNT))[:, 0]
        followed = asked.standoffs(ReachQuery(0, path, EVERY_APPROACH, COUNT))
        for row, first, last in zip(followed, start, free, strict=True):
            expected = _connected(int(first), int(last))
            assert int(row[1]) == expected
            assert int(row[0]) == (int(first) if expected else 0)


def _connected(seeds: int, mask: int) -> int:
    """Return the bits of a mask that are connected with a seed bit in it."""
    found = seeds & mask
    while True:
        grown = (found | found << 1 | found >> 1) & mask
        if grown == found:
            return found
        found = grown


def _paths(rng: np.random.Generator) -> Iterator[FloatArray]:
    """Return half circles over a table top at 0.79 m, as folds make them, on the grid of the queries."""
    for _ in range(6):
        turn = np.linspace(0.0, np.pi, 5)
        x, y, radius = rng.uniform(0.1, 0.7), rng.uniform(-0.3, 0.3), rng.uniform(0.05, 0.2)
        heights = 0.79 + radius * np.sin(turn)
        places: FloatArray = np.stack((x + 0.0 * turn, y + radius * np.cos(turn), heights), axis=1)
        yield np.round(places, 5)


def _naive_masks(arm: int, points: np.ndarray, comfort_m: float, among: np.ndarray | int = -1) -> np.ndarray:
    """Return the masks, of the standoffs that matter, by a query for each approach, point, standoff, comfort point."""
    masks = np.zeros((len(APPROACHES), len(points)), dtype=np.uint32)
    for index, comfortable in enumerate(_naive_comfort(arm, points, comfort_m)):
        row = [int(r) for r in (comfortable * (1 << np.arange(COUNT))).sum(axis=1) & among]
        arrived = [row[0]] if row else []
        for mask in row[1:]:
            arrived.append(_connected(arrived[-1], mask))
        masks[index] = arrived if all(arrived) else 0
    return masks


def _naive_comfort(arm: int, points: np.ndarray, comfort_m: float) -> np.ndarray:
    """Return whether each approach has each point in comfort from each standoff, shape (k, n, COUNT)."""
    ring = comfort_m * np.array([(0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)])
    back = STEP_M * np.arange(COUNT)[:, None] * np.array([1.0, 0.0, 0.0])
    asked = (points[:, None, None, :] + back[:, None, :] + ring).reshape(-1, 3)
    answers = [
        can_reach(ROBOT, arm, asked, np.broadcast_to(approach.rotation, (len(asked), 3, 3)), TORSO_M)
        for approach in APPROACHES
    ]
    return np.asarray(np.reshape(answers, (len(APPROACHES), len(points), COUNT, len(ring))).all(axis=3))


def _random_rotation(rng: np.random.Generator) -> np.ndarray:
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return np.asarray(rotation * np.linalg.det(rotation))


def test_a_plan_that_is_begun_meanwhile_knows_what_has_been_asked_and_is_charged_for_it() -> None:
    memories, paths = Memories(), list(_paths(np.random.default_rng(23)))
    first = bodiless(0.03, memories)
    known = [first.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT)) for points in paths]
    first.memory.share()
    left = memories.take()
    tested = left.bits[:, comfort.TESTED].copy()
    assert tested.any() and not left.bits[:, comfort.KNOWN].any()
    memories.leave(left)
    beside = bodiless(0.03, memories)
    for points, masks in zip(paths, known, strict=True):
        np.testing.assert_array_equal(beside.standoffs(ReachQuery(0, points, EVERY_APPROACH, COUNT)), masks)
    np.testing.assert_array_equal(left.bits[:, comfort.TESTED], tested)
    assert beside.memory.queries == first.memory.queries > 0
