"""Collisions: postures whose answer geometry gives, laws, the full meshes' hulls, and arms low over cloth."""

import math
from itertools import pairwise

import numpy as np
import pytest

from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.tolerance import LENGTH_M
from planner.robots.pr2.arm import MIRROR
from tests.replay import hulls
from tests.robots.collision_samples import CARD, FAR, FRONT, HOME, ROBOT, TORSO_M, both, random_postures, with_left
from tests.robots.model import joints_near

COLLISIONS = ROBOT.collisions(Table(), TORSO_M)
DOWN = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
ELBOW_OUT = np.array([0.8, -0.2, 1.0, -1.8, 0.0, -1.4, 0.0])
"""Joints of a left arm whose elbow is beside the hand, high over the table."""

STRETCHED = (0.0, 0.0, -0.2, 0.0, -0.2, 0.0)
"""All joints but the pan, of an arm that reaches out level."""


def test_arms_at_home_are_free() -> None:
    assert COLLISIONS.free(FRONT, HOME[None]).tolist() == [True]
    assert COLLISIONS.deepest_contact(FRONT, HOME) is None


def test_arms_that_cross_collide() -> None:
    # Pan axes are .188 m left and right of the middle. Panned inwards by .6, an arm gets there .188 / sin(.6) = .33 m
    # from its axis, and so does the other: upper arms reach from .1 to .5 m.
    crossed, parted = both(-0.6, *STRETCHED), both(0.6, *STRETCHED)
    assert COLLISIONS.arms_apart((0, 1), np.array([crossed, parted])).tolist() == [False, True]
    assert COLLISIONS.arm_free(0, FAR, crossed[None, 0]).tolist() == [True]
    assert COLLISIONS.arm_free(1, FAR, crossed[None, 1]).tolist() == [True]
    assert COLLISIONS.free(FAR, np.array([crossed, parted])).tolist() == [False, True]


def test_an_elbow_at_the_height_of_the_table_is_in_it() -> None:
    # The lift axis is .05 m ahead of the base's middle and 1.081 m high, .10 m before the edge; the table is .79 m
    # high. Lifted by .81 the upper arm's end, .4 m on, is .29 m lower and .28 m further ahead: at the top's height,
    # .18 m inside the edge.
    sunk, raised = (with_left(0.0, lift, 0.0, -1.5, 0.0, -0.5, 0.0) for lift in (0.81, -0.2))
    assert COLLISIONS.arm_free(0, FRONT, np.array([sunk[0], raised[0]])).tolist() == [False, True]
    contact = COLLISIONS.deepest_contact(FRONT, sunk)
    assert contact is not None
    assert contact.second == "table top"
    assert contact.first in ("left upper arm", "left elbow", "left forearm")
    assert COLLISIONS.arm_free(0, FAR, sunk[None, 0]).tolist() == [True]


def test_a_forearm_through_the_torso_collides() -> None:
    # Panned inwards by .7 = 40 degrees the elbow is at x = -.05 + .5 cos 40 = .33, y = .19 - .5 sin 40 = -.13. Rolled
    # by a quarter turn it bends inwards, level: 40 and 132 degrees are nearly straight back, so the wrist, .32 m on,
    # is near x = .01, y = -.17, and 1.08 m high. The torso is there: x up to .06, y from -.26 to .26, z from .57 on.
    through = with_left(-0.7, 0.0, math.pi / 2, -2.3, 0.0, -0.2, 0.0)
    assert COLLISIONS.arm_free(0, FAR, through[None, 0]).tolist() == [False]
    seen = hulls.contacts(CARD.joint_values(TORSO_M, list(through), [0.0, 0.0]), (-5.0, 0.0, 0.0), Table())
    assert ("torso_lift_link", "l_forearm_link") in [(first, second) for first, second, _ in seen]


@pytest.mark.parametrize(
    ("height_m", "met"),
    [(0.02, None), (0.005, "left fingertips"), (-0.02, "left fingertips"), (-0.045, "left fingers")],
)
def test_fingertips_may_be_a_hair_over_the_table_and_nothing_in_it(height_m: float, met: str | None) -> None:
    # Pointing straight down, tips end 19 mm below the tool frame, and closed fingers 27 mm above the tips. The top is
    # 30 mm thick: the deepest in it, or through it, are tips, then fingers.
    joints = joints_near(ROBOT, 0, np.array([0.6, 0.3, Table().height_m + height_m]), DOWN, TORSO_M, ELBOW_OUT)
    assert joints is not None
    wary = ROBOT.collisions(Table(), TORSO_M, margin_m=0.001)
    for collisions in (COLLISIONS, wary):
        assert collisions.arm_free(0, FRONT, joints[None]).tolist() == [met is None]
        contact = collisions.deepest_contact(FRONT, np.array([joints, HOME[1]]))
        assert (contact and (contact.first, contact.second)) == (met and (met, "table top"))


def test_shoulders_turn_over_the_edge_only_when_the_torso_is_down() -> None:
    # The edge is .20 m ahead of the pan axes at `front`. At the height of the top, .76 to .79 m, the hull of a
    # shoulder reaches .25 m from its axis when the torso is down, .17 m when it is up.
    turned = np.array([0.5, *HOME[0][1:]])
    assert COLLISIONS.arm_free(0, FRONT, turned[None]).tolist() == [True]
    lowered = ROBOT.collisions(Table(), 0.0)
    assert lowered.arm_free(0, FRONT, turned[None]).tolist() == [False]
    contact = lowered.deepest_contact(FRONT, np.array([turned, HOME[1]]))
    assert contact is not None
    assert (contact.first, contact.second) == ("left shoulder", "table top")
    assert 0.04 < contact.depth_m < 0.07  # .25 - .20, what makes shapes round and symmetric included


@pytest.mark.parametrize(
    ("torso_m", "opening_m"),
    [
        pytest.param(0.0, 0.0, marks=pytest.mark.long),
        pytest.param(0.12, 0.03, marks=pytest.mark.long),
        (TORSO_M, 0.06),
        pytest.param(0.31, 0.09, marks=pytest.mark.long),
    ],
)
def test_what_is_free_is_free_for_the_full_meshes_hulls(torso_m: float, opening_m: float) -> None:
    rng = np.random.default_rng(11)
    collisions, postures = ROBOT.collisions(Table(), torso_m, opening_m), random_postures(150, 12)
    agreed = 0
    for posture in postures:
        base = (rng.uniform(-1.75, -0.95), rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4))
        openings = rng.uniform(0.0, opening_m, 2)
        seen = hulls.contacts(CARD.joint_values(torso_m, posture, openings.tolist()), base, Table())
        is_free = bool(collisions.free(Pose2(*base), posture[None])[0])
        assert not (is_free and seen), f"free, but {seen[0]}"
        agreed += is_free == (not seen)
    assert agreed >= 0.95 * len(postures), f"only {agreed} of {len(postures)} answers are those of the meshes"


def test_postures_are_apart_as_they_are_pair_by_pair() -> None:
    rng, apart, met = np.random.default_rng(14), 0, 0
    for _ in range(12):
        # Hands beside each other over the table, 4 to 30 cm apart, each in all samples of its arm's postures.
        place, gap_m = rng.uniform((0.45, -0.1, 0.85), (0.7, 0.1, 1.1)), rng.uniform(0.04, 0.3)
        aside = np.array([0.0, gap_m / 2, 0.0])
        left, right = (
            ROBOT.free_postures(arm, place + side * aside, DOWN, TORSO_M, lambda joints: np.ones(len(joints), bool))
            for arm, side in ((0, 1), (1, -1))
        )
        found = COLLISIONS.postures_apart((0, 1), left, right)
        pairs = np.stack([left.repeat(len(right), 0), np.tile(right, (len(left), 1))], axis=1)
        np.testing.assert_array_equal(found.ravel(), COLLISIONS.arms_apart((0, 1), pairs))
        assert COLLISIONS.are_some_apart((0, 1), left, right) == found.any()
        apart, met = apart + int(found.sum()), met + int((~found).sum())
    assert min(apart, met) > 100
    assert COLLISIONS.postures_apart((0, 1), np.empty((0, 7)), HOME[:1]).shape == (0, 1)
    assert not COLLISIONS.are_some_apart((0, 1), np.empty((0, 7)), HOME[:1])


def test_nothing_collides_exactly_when_body_each_arm_and_both_do_not() -> None:
    postures = random_postures(300, 13)
    for base in (FRONT, FRONT.ahead(-0.4), FAR):
        parts = COLLISIONS.arms_apart((0, 1), postures)
        for arm in (0, 1):
            parts &= COLLISIONS.arm_free(arm, base, postures[:, arm])
        np.testing.assert_array_equal(COLLISIONS.free(base, postures), parts & COLLISIONS.body_free(base))


def test_a_mirrored_posture_has_the_mirrored_answer() -> None:
    postures = random_postures(500, 14)
    mirrored = postures[:, ::-1] * MIRROR
    base, seen_in_mirror = Pose2(-1.0, 0.2, 0.3), Pose2(-1.0, -0.2, -0.3)
    np.testing.assert_array_equal(COLLISIONS.free(base, postures), COLLISIONS.free(seen_in_mirror, mirrored))
    np.testing.assert_array_equal(
        COLLISIONS.arm_free(0, base, postures[:, 0]), COLLISIONS.arm_free(1, seen_in_mirror, mirrored[:, 1])
    )


def test_a_posture_is_answered_alike_alone_and_among_others() -> None:
    postures = random_postures(60, 15)
    alone = [bool(COLLISIONS.free(FRONT, posture[None])[0]) for posture in postures]
    assert COLLISIONS.free(FRONT, postures).tolist() == alone
    assert len(set(alone)) == 2
    assert COLLISIONS.free_until(FRONT, postures) == alone.index(False)
    assert COLLISIONS.free(FRONT, postures[:0]).shape == (0,)


def test_a_posture_is_answered_alike_alone_and_on_the_way_of_moving_arms_and_a_moving_base() -> None:
    corners, stands = (
        random_postures(13, 22),
        np.random.default_rng(23).uniform((-1.4, -0.3, -0.3), (-0.8, 0.3, 0.3), (13, 3)),
    )
    shares = np.linspace(0.0, 1.0, 40)
    ways, bases = (
        np.concatenate([a + np.multiply.outer(shares, b - a) for a, b in pairwise(ends)]) for ends in (corners, stands)
    )
    for arm in (0, 1):
        found = COLLISIONS.arm_free(arm, bases, ways[:, arm])
        each = zip(bases, ways, strict=True)
        assert found.tolist() == [bool(COLLISIONS.arm_free(arm, b[None], q[None, arm])[0]) for b, q in each]
        assert 50 < found.sum() < 450
    alone = [bool(COLLISIONS.free(Pose2(*base), posture[None])[0]) for base, posture in zip(bases, ways, strict=True)]
    assert COLLISIONS.free(bases, ways).tolist() == alone
    stretches = [COLLISIONS.is_path_free(bases[k : k + 3], ways[k : k + 3]) for k in range(len(ways) - 2)]
    assert stretches == [all(alone[k : k + 3]) for k in range(len(ways) - 2)]
    assert 10 < sum(stretches) < sum(alone) < 450


def test_a_path_is_free_only_if_nothing_touches_between_its_postures() -> None:
    starts = random_postures(12_000, 31)
    ends = starts + np.random.default_rng(32).uniform(-1.0, 1.0, starts.shape)

    def sampled(count: int) -> FloatArray:
        return np.array([(1.0 - share) * starts + share * ends for share in np.linspace(0.0, 1.0, count)])

    paths = sampled(5)
    where_free = np.flatnonzero(np.array([COLLISIONS.free(FRONT, postures) for postures in paths]).all(axis=0))
    found = np.array([COLLISIONS.is_path_free(FRONT, paths[:, number]) for number in where_free])
    between = np.array([COLLISIONS.free(FRONT, postures[where_free]) for postures in sampled(97)]).all(axis=0)
    assert found.tolist() == between.tolist()
    assert 10 < (~between).sum() < 100


def test_each_posture_may_have_a_base_of_its_own() -> None:
    postures, rng = random_postures(60, 19), np.random.default_rng(20)
    bases = np.column_stack([rng.uniform(-1.5, -0.9, 60), rng.uniform(-0.4, 0.4, 60), rng.uniform(-0.4, 0.4, 60)])
    alone = [
        bool(COLLISIONS.free(Pose2(*base), posture[None])[0]) for base, posture in zip(bases, postures, strict=True)
    ]
    assert COLLISIONS.free(bases, postures).tolist() == alone
    assert COLLISIONS.free_until(bases[alone], postures[alone]) == sum(alone)
    assert len(set(alone)) == 2


def test_the_deepest_contact_is_none_exactly_where_nothing_collides() -> None:
    postures = random_postures(100, 16)
    contacts = [COLLISIONS.deepest_contact(FRONT, posture) for posture in postures]
    assert [contact is None for contact in contacts] == COLLISIONS.free(FRONT, postures).tolist()
    assert all(contact.depth_m >= 0.0 for contact in contacts if contact)


def test_a_margin_deepens_every_contact_by_itself_but_fingertips_with_the_top() -> None:
    postures, margin_m = random_postures(200, 17), 0.02
    wary = ROBOT.collisions(Table(), TORSO_M, margin_m=margin_m)
    is_free, keeps_off = COLLISIONS.free(FRONT, postures), wary.free(FRONT, postures)
    assert np.all(is_free[keeps_off])
    assert keeps_off.sum() < is_free.sum()
    for posture in postures[~is_free]:
        bare, with_margin = COLLISIONS.deepest_contact(FRONT, posture), wary.deepest_contact(FRONT, posture)
        assert bare is not None
        assert with_margin is not None
        if not (bare.first.endswith("fingertips") and bare.second == "table top"):
            assert with_margin.depth_m == pytest.approx(bare.depth_m + margin_m, abs=LENGTH_M)


def test_wider_open_fingers_collide_wherever_closed_ones_do() -> None:
    postures = random_postures(300, 18)
    closed, wide = (ROBOT.collisions(Table(), TORSO_M, opening_m).free(FRONT, postures) for opening_m in (0.0, 0.09))
    assert np.all(closed[wide])


OVER_M = 0.03
CLOTH = np.array([(-0.5, 0.1), (-0.3, 0.1), (-0.3, 0.4), (-0.5, 0.4)])
"""Cloth in the base frame at `front` from 0.45 to 0.65 m ahead; the tool is in its middle at 0.55 m."""


def pointing_down(arm: int, height_m: float, ahead_m: float = 0.55) -> np.ndarray:
    side = 1.0 - 2.0 * arm
    place = np.array([ahead_m, side * 0.25, Table().height_m + height_m])
    near = ELBOW_OUT if arm == 0 else ELBOW_OUT * [-1, 1, -1, 1, -1, 1, -1]
    joints = joints_near(ROBOT, arm, place, DOWN, TORSO_M, near)
    assert joints is not None
    return joints


@pytest.mark.parametrize("arm", [0, 1])
def test_fingertips_must_be_so_high_over_cloth_and_not_beside_it(arm: int) -> None:
    # Tips end 19 mm below the tool frame.
    piece = CLOTH * [1.0, 1.0 - 2.0 * arm]
    clearance = ROBOT.collisions(Table(), TORSO_M).over_cloth([piece[:: 1 - 2 * arm]], OVER_M)
    joints = np.array([pointing_down(arm, z) for z in (0.02, 0.045, 0.055, 0.1)])
    found = clearance.arm_clear(arm, FRONT, joints)
    assert found.tolist() == [False, False, True, True]
    assert clearance.arm_clear(arm, FRONT, pointing_down(arm, 0.02, 0.4)[None]).tolist() == [True]


def test_without_cloth_everything_is_clear() -> None:
    clearance = ROBOT.collisions(Table(), TORSO_M).over_cloth([], OVER_M)
    assert clearance.arm_clear(0, FRONT, pointing_down(0, 0.0)[None]).tolist() == [True]


def test_arms_at_home_are_clear_of_cloth_on_all_of_the_table() -> None:
    whole = np.array(Table().corners)
    clearance = ROBOT.collisions(Table(), TORSO_M).over_cloth([whole], OVER_M)
    assert all(clearance.arm_clear(arm, FRONT, HOME[arm][None]).all() for arm in (0, 1))
