"""The cause and size of a shortfall, against the definition: displace the point, and query again."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.pose import Approach
from planner.geometry.reach_query import ReachQuery, Shortfall
from planner.robots.comfort_reach import ComfortReach
from planner.robots.displacements import DIRECTIONS, FURTHEST_M
from planner.robots.pr2 import reach as reach_module
from planner.robots.pr2 import shortfall
from planner.robots.pr2.aim import ToolPose
from planner.robots.pr2.arm import read_arm
from planner.robots.pr2.joint_slack import slacks
from planner.robots.pr2.kernel import JOINT_NAMES, joint_slacks
from planner.robots.pr2.mirrored_arm import MirroredArm
from planner.robots.pr2.reach import APPROACHES, Pr2Reach
from tests.required import required
from tests.robots.model import MODEL, the_pr2

ROBOT = the_pr2()
TORSO_M = 0.29
COMFORT_M = 0.03
TABLE_M = 0.79
EVERY_APPROACH = np.arange(len(APPROACHES))
FORWARD = np.array([APPROACHES.index(Approach(0.0, math.radians(30)))])
"""Fingers ahead, 30 degrees down."""

TO_THE_RIGHT = np.array([APPROACHES.index(Approach(-math.pi / 2, math.radians(30)))])

STANDS = np.arange(5)[:, None] * np.array([0.05, 0.0, 0.0])
"""The displacements of points, as the base sees them, when it backs off in steps of 5 cm."""


@pytest.mark.parametrize("approaches", [EVERY_APPROACH, FORWARD])
@pytest.mark.parametrize("arm", [0, 1])
def test_displaced_by_what_it_is_short_a_point_is_in_comfort(arm: int, approaches: NDArray[np.int64]) -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    for point, found in _displaced(reach, arm, approaches):
        there = point + (found.short_by_m + 0.001) * np.array(found.towards)
        assert reach.from_anywhere(ReachQuery(arm, there[None], np.array([found.approach]))).all()


@pytest.mark.parametrize("approaches", [EVERY_APPROACH, FORWARD])
@pytest.mark.parametrize("arm", [0, 1])
def test_no_smaller_displacement_brings_a_point_into_comfort(arm: int, approaches: NDArray[np.int64]) -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    for point, found in _displaced(reach, arm, approaches):
        distances = _shells(found.short_by_m - 0.001)
        tried = point + distances[:, None, None] * DIRECTIONS
        assert not reach.from_anywhere(ReachQuery(arm, tried.reshape(-1, 3), approaches)).any()


@pytest.mark.parametrize("arm", [0, 1])
def test_seen_from_several_places_of_the_base_the_nearest_counts(arm: int) -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    places = [point + STANDS for point in _points(np.random.default_rng(36), 40)]
    together = [shortfall_of(reach, arm, seen, EVERY_APPROACH) for seen in places]
    each = [[shortfall_of(reach, arm, point, EVERY_APPROACH) for point in seen] for seen in places]
    assert 5 < sum(found is None for found in together) < 35
    for found, alone in zip(together, each, strict=True):
        assert (found is None) == (None in alone)
        if found is not None:
            assert found.short_by_m == pytest.approx(min(required(one).short_by_m for one in alone), abs=0.001)
            assert found.short_by_m == pytest.approx(required(alone[found.seen_from]).short_by_m, abs=0.001)


@pytest.mark.parametrize("arm", [0, 1])
def test_places_to_be_had_in_one_approach_are_short_by_the_worst_in_the_best(arm: int) -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    rng = np.random.default_rng(37)
    ways = [_points(rng, 3)[:, None] + STANDS for _ in range(16)]
    some = EVERY_APPROACH[::4]
    lacking = 0
    for way in ways:
        found = reach.shortfall(ReachQuery(arm, way, some))
        in_each = [[shortfall_of(reach, arm, seen, np.array([a])) for seen in way] for a in some]
        worst = [max((0.0 if one is None else one.short_by_m) for one in row) for row in in_each]
        if found is None:
            assert min(worst) == 0.0
        else:
            lacking += 1
            assert found.short_by_m == pytest.approx(min(worst), abs=0.001)
            assert replace(found, place=0) == in_each[list(some).index(found.approach)][found.place]
            bounded = reach.shortfall(ReachQuery(arm, way, some), at_most_m=min(worst) / 2)
            assert bounded is not None
            assert bounded.short_by_m >= min(worst) / 2
    assert lacking > 8


@pytest.mark.parametrize("arm", [0, 1])
def test_the_lower_bound_is_one_and_mostly_tells(arm: int) -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    rng = np.random.default_rng(38)
    ways = np.stack([_points(rng, 2) for _ in range(60)])
    bounds = reach.at_least_short(ReachQuery(arm, ways, EVERY_APPROACH, len(STANDS)))
    found = [reach.shortfall(ReachQuery(arm, way[:, None] + STANDS, EVERY_APPROACH)) for way in ways]
    short = np.array([0.0 if one is None else one.short_by_m for one in found])
    assert np.all(bounds <= short + 1e-9)
    assert np.mean(bounds[short > 0.05] > 0.5 * short[short > 0.05]) > 0.5


@pytest.mark.parametrize("arm", [0, 1])
def test_what_is_within_reach_has_no_lower_bound_behind_the_shoulder_either(arm: int) -> None:
    reach = ROBOT.reach(TORSO_M, 0.0)
    points = np.random.default_rng(40).uniform((-0.9, -1.0, 0.2), (0.6, 1.0, 1.9), (2000, 3))
    is_within_margin = reach.from_anywhere(ReachQuery(arm, points, EVERY_APPROACH))
    bounds = np.array([reach.at_least_short(ReachQuery(arm, points[:, None], np.array([a]))) for a in EVERY_APPROACH])
    assert is_within_margin[:, points[:, 0] < 0.0].sum() > 100
    assert bounds[is_within_margin].max() <= 0.0
    assert (bounds[:, points[:, 0] < 0.0] > 0.05).mean() > 0.5


@pytest.mark.parametrize("arm", [0, 1])
def test_a_search_that_is_over_ends_with_a_lower_bound(arm: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shortfall, "PIECE_QUERIES", 1)
    reach, cut_short = ROBOT.reach(TORSO_M, COMFORT_M), 0
    for point, whole in _displaced(reach, arm, EVERY_APPROACH):
        cut = required(shortfall_of(reach, arm, point, EVERY_APPROACH, deadline=Deadline(-1.0)))
        assert cut.is_at_least or cut == whole
        assert cut.short_by_m <= whole.short_by_m
        cut_short += cut.is_at_least
    assert cut_short >= 3


@pytest.mark.parametrize("arm", [0, 1])
def test_of_places_to_be_had_together_only_the_approaches_examined_in_time_count(
    arm: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reach_module, "PIECE_QUERIES", 1)
    reach, cut_short = ROBOT.reach(TORSO_M, COMFORT_M), 0
    rng = np.random.default_rng(41)
    for way in (_points(rng, 3)[:, None] + STANDS for _ in range(16)):
        whole = reach.shortfall(ReachQuery(arm, way, EVERY_APPROACH))
        cut = reach.shortfall(ReachQuery(arm, way, EVERY_APPROACH), deadline=Deadline(-1.0))
        if whole is None or cut is None or cut == whole:
            continue
        cut_short += 1
        is_bound = cut.is_at_least
        assert cut.short_by_m <= whole.short_by_m if is_bound else cut.short_by_m >= whole.short_by_m
    assert cut_short >= 3


def test_a_straight_arm_lacks_exactly_what_the_bones_lack() -> None:
    # Fingers ahead, 30 degrees down, at the height at which the wrist is level with the shoulder: it is ahead of the
    # lift axis by 0.4 and 0.321 m at most, with an elbow that stays bent by its soft limit of 0.15 rad. That axis is
    # 0.1 m ahead of the pan axis, which is 5 cm behind the base's middle. The tool is 0.18 m from the wrist.
    level = 0.051 + 0.739675 + TORSO_M - 0.18 * np.sin(np.pi / 6)
    bones = np.hypot(0.4 + 0.321 * np.cos(0.15), 0.321 * np.sin(0.15))
    furthest = -0.05 + 0.1 + bones + 0.18 * np.cos(np.pi / 6)
    for comfort_m in (0.0, COMFORT_M):
        reach = ROBOT.reach(TORSO_M, comfort_m)
        found = required(shortfall_of(reach, 0, np.array([furthest + 0.2, 0.188, level]), FORWARD))
        assert (found.cause, found.joint, found.towards) == ("too_far", None, (-1.0, 0.0, 0.0))
        # The furthest point of the comfort circle must be in reach too.
        assert found.short_by_m == pytest.approx(0.2 + comfort_m, abs=0.0015)


def test_where_only_the_body_is_in_the_way_it_is_to_blame() -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    alone = Pr2Reach(("left",), (MirroredArm(read_arm(MODEL), is_mirrored=False),), TORSO_M, COMFORT_M)
    # An elbow at its soft limit of 2.1213 rad keeps the wrist 0.36 m from the lift axis, at 1.08 m: nearer than that a
    # limit is to blame, so it is lower down that only the body is.
    points = np.random.default_rng(39).uniform((-0.1, -0.3, 0.4), (0.5, 0.5, 0.9), (200, 3))
    found = [(point, shortfall_of(reach, 0, point, FORWARD)) for point in points]
    hindered = [point for point, one in found if one is not None and one.cause == "own_body"]
    assert len(hindered) >= 3
    for point, one in found:
        is_to_blame = one is not None and one.cause == "own_body"
        assert is_to_blame == (one is not None and shortfall_of(alone, 0, point, FORWARD) is None)


@pytest.mark.parametrize("comfort_m", [0.0, COMFORT_M])
@pytest.mark.parametrize("arm", [0, 1])
def test_there_is_no_shortfall_exactly_in_comfort(arm: int, comfort_m: float) -> None:
    reach = ROBOT.reach(TORSO_M, comfort_m)
    points = _points(np.random.default_rng(31), 100)
    in_comfort = reach.from_anywhere(ReachQuery(arm, points, EVERY_APPROACH)).any(axis=0)
    assert 20 < in_comfort.sum() < 80
    assert [shortfall_of(reach, arm, point, EVERY_APPROACH) is None for point in points] == in_comfort.tolist()


def test_mirror_images_are_short_by_the_same() -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    by_direction = {(a.heading_rad, a.pitch_rad): i for i, a in enumerate(APPROACHES)}
    mirrored = np.array([by_direction[-a.heading_rad, a.pitch_rad] for a in APPROACHES])
    for point in _points(np.random.default_rng(32), 60):
        left = shortfall_of(reach, 0, point, EVERY_APPROACH)
        right = shortfall_of(reach, 1, point * np.array([1.0, -1.0, 1.0]), mirrored)
        if left is None or right is None:
            assert left is right
            continue
        x, y, z = left.towards
        assert right == replace(left, towards=(x, -y, z), approach=int(mirrored[left.approach]))


@pytest.mark.parametrize("arm", [0, 1])
def test_only_comfort_is_missing_exactly_where_the_point_itself_is_reachable(arm: int) -> None:
    comfortable, bare = ROBOT.reach(TORSO_M, COMFORT_M), ROBOT.reach(TORSO_M, 0.0)
    causes = []
    for point in _points(np.random.default_rng(33), 150):
        found = shortfall_of(comfortable, arm, point, FORWARD)
        if found is not None:
            assert (found.cause == "comfort_only") == (shortfall_of(bare, arm, point, FORWARD) is None)
            causes.append(found.cause)
    assert {"comfort_only", "too_far", "too_near"} <= set(causes)


@pytest.mark.parametrize("approaches", [EVERY_APPROACH, FORWARD])
def test_with_comfort_only_lacking_the_largest_circle_is_told(approaches: NDArray[np.int64]) -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    asked = [(p, shortfall_of(reach, 0, p, approaches)) for p in _points(np.random.default_rng(34), 400)]
    short = [(p, found) for p, found in asked if found is not None and found.cause == "comfort_only"]
    assert len(short) >= 5
    for point, found in short:
        largest_m = required(found.comfort_m)
        there, beyond = (ROBOT.reach(TORSO_M, radius_m) for radius_m in (largest_m, largest_m + 0.0011))
        assert there.from_anywhere(ReachQuery(0, point[None], approaches)).any()
        assert not beyond.from_anywhere(ReachQuery(0, point[None], approaches)).any()


def test_two_metres_ahead_is_too_far_for_any_joint() -> None:
    found = shortfall_of(ROBOT.reach(TORSO_M, COMFORT_M), 0, np.array([2.0, 0.0, TABLE_M]), EVERY_APPROACH)
    assert found is not None
    assert (found.cause, found.joint) == ("too_far", None)
    # Shoulder to tool is at most 0.1 + 0.4 + 0.321 + 0.18 m, and the shoulder is 5 cm behind the base's middle.
    assert found.is_at_least
    assert found.short_by_m >= max(FURTHEST_M, 2.05 - 1.001)
    assert found.towards[0] < -0.9


def test_a_little_too_far_ahead_is_short_backwards() -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    # The straight arm leads 0.901 m from the lift axis, so the wrist of a forward tool is at most at x = 0.771 m.
    found = shortfall_of(reach, 0, np.array([1.2, 0.188, 1.0]), FORWARD)
    assert found is not None
    assert (found.cause, found.joint) == ("too_far", None)
    assert found.towards[0] == pytest.approx(-1.0)


def test_a_place_at_the_shoulders_foot_is_too_near() -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    for arm, (x, y, _) in enumerate(reach.shoulders):
        found = shortfall_of(reach, arm, np.array([x, y, TABLE_M]), FORWARD)
        assert found is not None
        assert found.cause == "too_near"
        assert found.joint in JOINT_NAMES


def test_a_place_high_above_is_too_far_and_must_come_down() -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    found = shortfall_of(reach, 0, np.array([0.5, 0.188, 1.75]), FORWARD)
    assert found is not None
    assert found.cause == "too_far"
    assert found.towards[2] == -1.0


def test_far_to_the_other_side_the_shoulders_pan_limits() -> None:
    """A left arm cannot turn far to the right: its pan ends at -41 degrees."""
    found = shortfall_of(ROBOT.reach(TORSO_M, COMFORT_M), 0, np.array([0.1, -0.75, 1.0]), TO_THE_RIGHT)
    assert found is not None
    assert found.joint == "shoulder pan"


def test_the_joints_slacks_are_those_of_the_kernel() -> None:
    shape = read_arm(MODEL)
    rng = np.random.default_rng(35)
    compared = 0
    for _ in range(2000):
        axis = rng.normal(size=3)
        aim = ToolPose(*rng.uniform(-0.8, 0.8, 3), *(axis / np.linalg.norm(axis)))
        pan = rng.uniform(shape.pan.low, shape.pan.high)
        for branch, least in zip((1.0, -1.0), slacks(shape, aim, pan), strict=True):
            if least > -1.0:
                assert min(joint_slacks(shape, aim, pan, branch)[1:]) == pytest.approx(least, abs=1e-9)
                compared += 1
    assert compared > 300


def test_queries_and_time_are_counted() -> None:
    reach = ROBOT.reach(TORSO_M, COMFORT_M)
    shortfall_of(reach, 0, np.array([0.0, 0.188, TABLE_M]), EVERY_APPROACH)
    assert reach.memory.queries > len(EVERY_APPROACH)
    assert reach.memory.query_time_s > 0.0


def test_asking_in_no_approach_is_refused() -> None:
    with pytest.raises(ValueError, match="approach"):
        shortfall_of(ROBOT.reach(TORSO_M, COMFORT_M), 0, np.zeros(3), np.array([], dtype=int))


@pytest.mark.parametrize(
    "wrong",
    [
        {"cause": "tired"},
        {"short_by_m": np.inf},
        {"short_by_m": -0.1},
        {"towards": (1.0, 1.0, 0.0)},
        {"cause": "comfort_only"},
        {"comfort_m": 0.01},
    ],
)
def test_a_shortfall_that_is_none_is_refused(wrong: dict[str, Any]) -> None:
    right = Shortfall("too_far", None, 0.1, False, (1.0, 0.0, 0.0), approach=0, seen_from=0)
    with pytest.raises(ValueError, match=r"no cause|short by|direction|comfort"):
        replace(right, **wrong)


def shortfall_of(
    reach: ComfortReach, arm: int, seen: np.ndarray, approaches: NDArray[np.int64], deadline: Deadline = ENDLESS
) -> Shortfall | None:
    """Return the shortfall of one place, as seen from one place of the base or several."""
    return reach.shortfall(ReachQuery(arm, np.reshape(seen, (1, -1, 3)), approaches), deadline=deadline)


def _shells(furthest: float) -> np.ndarray:
    """Return distances from 0 on, each 2 mm or 3 % of the distance beyond the last, up to a limit (m)."""
    found = [0.0]
    while found[-1] < furthest:
        found.append(found[-1] + max(0.002, 0.03 * found[-1]))
    return np.array(found[:-1])


def _points(rng: np.random.Generator, count: int) -> np.ndarray:
    """Return places over a table and around it, on the grid of the queries (m)."""
    return np.round(rng.uniform((-0.2, -0.8, 0.7), (1.3, 0.8, 1.3), (count, 3)), 5)


def _displaced(reach: ComfortReach, arm: int, approaches: np.ndarray) -> list[tuple[np.ndarray, Shortfall]]:
    """Yield points out of reach for which a displacement that helps was found."""
    asked = [(point, shortfall_of(reach, arm, point, approaches)) for point in _points(np.random.default_rng(30), 60)]
    found = [(p, f) for p, f in asked if f is not None and not f.is_at_least]
    assert len(found) >= 15
    return found
