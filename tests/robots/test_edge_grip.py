"""At which pitch and height a gripper takes an edge of cloth: by hand for boxes, by the meshes for shipped robots."""

import math

import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.robots.card import EDGE_OPEN_M, HELD_M
from planner.robots.collision.link_shapes import link_shapes
from planner.robots.collision.rigid_groups import Carrier, Skeleton
from planner.robots.described_robot import DescribedRobot, read_robot
from planner.robots.edge_grip import BODY_CLEAR_M, FINGER_CLEAR_M, HandShape, edge_raised_m
from planner.robots.known_robots import shipped_path
from planner.robots.load_robot import load_robot, robot_card_file
from tests.sweep import sweep

HEIGHT_M = 0.02
PITCHES_DEG = (15, 30, 45, 60, 75)
THICK_M, WIDE_M, PALM_M = 0.008, 0.02, 0.05

RAISED = "arms.0.tool.offset_m=[0.003,0,0]:arms.1.tool.offset_m=[0.003,0,0]"
"""Tool points 3 mm nearer to a PR2's fingertips, as docs/robots.md has it."""


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> FloatArray:
    return np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])


def hand(*, jaw_m: float = THICK_M, palm_m: float = PALM_M, rounding_m: float = 0.0) -> HandShape:
    """Return two fingers of a thickness with their tips at the tool, 4 cm long, on a palm of half a width."""
    openings = (0.0, HELD_M, EDGE_OPEN_M, 0.04)

    def parts(opening_m: float) -> tuple[tuple[FloatArray, float], ...]:
        away = jaw_m + opening_m / 2
        fingers = box((-0.04, -away, -WIDE_M / 2), (0.0, away, WIDE_M / 2))
        return (box((-0.1, -palm_m, -0.03), (-0.04, palm_m, 0.03)), 0.0), (fingers, rounding_m)

    return HandShape(openings, tuple(parts(opening) for opening in openings), (False, True))


@pytest.mark.parametrize("pitch_deg", [45, 60])
def test_the_lower_finger_of_boxes_just_clears_the_table(pitch_deg: float) -> None:
    pitch = math.radians(pitch_deg)
    sole_m = HEIGHT_M - (THICK_M + EDGE_OPEN_M / 2) * math.cos(pitch)
    assert edge_raised_m(hand(), HEIGHT_M, pitch) == pytest.approx(FINGER_CLEAR_M - sole_m)


def test_rounding_raises_the_hand_by_its_radius() -> None:
    plain, rounded = (edge_raised_m(hand(rounding_m=r), HEIGHT_M, math.radians(45)) for r in (0.0, 0.001))
    assert plain is not None and rounded == pytest.approx(plain + 0.001)


def test_a_palm_that_would_be_in_the_table_allows_no_such_grip() -> None:
    # At 30 degrees its lower corner is .04 sin 30 - .05 cos 30 = -2.3 cm from the tool's height.
    assert edge_raised_m(hand(), HEIGHT_M, math.radians(30)) is None
    assert edge_raised_m(hand(palm_m=0.02), HEIGHT_M, math.radians(30)) is not None


def test_a_palm_that_comes_lowest_says_how_far_the_hand_may_be_lowered() -> None:
    pitch, palm_m = math.radians(45), 0.053
    low_m = HEIGHT_M + 0.04 * math.sin(pitch) - palm_m * math.cos(pitch)
    assert edge_raised_m(hand(palm_m=palm_m), HEIGHT_M, pitch) == pytest.approx(BODY_CLEAR_M - low_m)


def test_fingers_too_thick_for_the_room_over_the_table_allow_none() -> None:
    assert edge_raised_m(hand(jaw_m=0.0285), HEIGHT_M, math.radians(45)) is None


def test_the_finger_that_can_come_lower_is_the_lower_one() -> None:
    # A jaw that stays where it is on one side, and one that opens widely on the other.
    plain = hand()
    shifted = tuple(
        tuple((corners + np.array([0.0, 0.5 * opening, 0.0]), r) for corners, r in of_level)
        for opening, of_level in zip(plain.openings_m, plain.hulls, strict=True)
    )
    fixed_below = HandShape(plain.openings_m, shifted, plain.is_tip)
    pitch = math.radians(60)
    sole_m = HEIGHT_M - THICK_M * math.cos(pitch)
    assert edge_raised_m(fixed_below, HEIGHT_M, pitch) == pytest.approx(FINGER_CLEAR_M - sole_m)


SHIPPED = {"pr2": (45,), "panda-pair": (60, 75), "tiago-pro": (30, 45, 60, 75)}
"""The pitches at which the grippers of some robots have room for a finger under the cloth (degrees)."""


@sweep("name", SHIPPED, quick=["pr2", "panda-pair"])
def test_the_meshes_of_a_hand_clear_the_table_and_its_lower_finger_slides_on_it(name: str) -> None:
    robot, described = load_robot(name), read_robot(name)
    found = {p: robot.edge_raised_m(0, HEIGHT_M, math.radians(p)) for p in PITCHES_DEG}
    assert tuple(pitch for pitch, raised_m in found.items() if raised_m is not None) == SHIPPED[name]
    opened, held = hand_points(described, EDGE_OPEN_M), hand_points(described, HELD_M)
    for pitch_deg, raised_m in found.items():
        lowest_held, lowest_open = (lowest_m(points, math.radians(pitch_deg)) for points in (held, opened))
        if raised_m is None:
            assert HEIGHT_M + lowest_held < 0.0008, f"{pitch_deg} degrees: there would be room"
        else:
            assert HEIGHT_M + lowest_held >= 0.0
            assert 0.0 <= HEIGHT_M + raised_m + lowest_open < 0.003


def lowest_m(points: FloatArray, pitch_rad: float) -> float:
    """Return the height over the tool of a hand's lowest point, with the closing axis upright; the better side."""
    heights = (-points[:, 0] * math.sin(pitch_rad) + side * points[:, 1] * math.cos(pitch_rad) for side in (1, -1))
    return max(float(one.min()) for one in heights)


def hand_points(robot: DescribedRobot, opening_m: float) -> FloatArray:
    """Return the corners of all shapes of the first arm's hand and fingers, seen from its tool, shape (n, 3)."""
    skeleton, arm = Skeleton(robot), robot.arms[0]
    last = Carrier(0, len(arm.card.joints) - 1)

    def is_wanted(joint: int) -> bool:
        carrier = skeleton.carrier(joint)
        return carrier.arm == 0 and (carrier.is_finger or carrier == last)

    clouds = []
    for shape in link_shapes(skeleton.model, robot.urdf, is_wanted):
        if skeleton.carrier(shape.joint).is_finger:
            place = skeleton.placement_open(shape, opening_m) * shape.placement.inverse()
            clouds.append(shape.corners @ place.rotation.T + place.translation)
        else:
            clouds.append(skeleton.points(shape))
    return (np.vstack(clouds) - arm.chain.tool_offset) @ arm.chain.tool_rotation


@pytest.mark.parametrize(("pitch_deg", "more_m"), [(90, 0.003), (45, 0.003 * math.sin(math.radians(45.0)))])
def test_a_tool_point_nearer_to_the_tips_keeps_fingers_further_from_the_table(pitch_deg: int, more_m: float) -> None:
    cards = (robot_card_file(name) for name in ("pr2", f"pr2@{RAISED}"))
    folder = shipped_path("pr2").parent
    shipped, varied = (hand_points(DescribedRobot.of(card, folder), HELD_M) for card in cards)
    before_m, after_m = (lowest_m(points, math.radians(pitch_deg)) for points in (shipped, varied))
    assert after_m - before_m == pytest.approx(more_m)
