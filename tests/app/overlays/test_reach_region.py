import math
from functools import partial

import numpy as np
import pytest

from app.overlays.reach_region import Grid, reach_regions, region_where, takeable, takeable_region
from planner.geometry.isometry import Isometry
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.robots.load_robot import load_robot
from planner.robots.pr2.robot import Pr2
from tests.replay.planned import shipped_plan
from tests.required import required
from tests.robots.model import can_reach

TORSO_M, HEIGHT_M = 0.29, 0.79
GRID = Grid.beside((0.0, 0.2))


@pytest.fixture(scope="module")
def comfortable() -> tuple[Region, ...]:
    return reach_regions(load_robot("pr2"), TORSO_M, 0.03, HEIGHT_M)


@pytest.fixture(scope="module")
def bare() -> tuple[Region, ...]:
    return reach_regions(load_robot("pr2"), TORSO_M, 0.0, HEIGHT_M)


def test_a_disc_is_found_to_a_sixteenth_of_the_grid() -> None:
    middle, radius = np.array([0.411, -0.137]), 0.5

    def is_in_disc(points: FloatArray) -> BoolArray:
        inside: BoolArray = np.hypot(*(points - middle).T) <= radius
        return inside

    found = region_where(is_in_disc, GRID)
    away = np.hypot(*(found.coordinates - middle).T)
    # Corners are inside, at most 2 cm / 2^4 along the grid; chords over a cell of 2 cm sink by 0.02^2 / (8 * 0.5) more.
    assert radius - 0.02 / 16 - 1e-4 <= away.min()
    assert away.max() <= radius + 1e-6
    assert found.area == pytest.approx(math.pi * radius**2, rel=0.01)


def test_holes_and_separate_parts_are_kept() -> None:
    def is_in(points: FloatArray) -> BoolArray:
        away = np.hypot(*(points - [0.4, 0.0]).T)
        inside: BoolArray = ((away > 0.2) & (away < 0.4)) | (np.hypot(*(points - [0.4, 0.9]).T) < 0.1)
        return inside

    found = region_where(is_in, GRID)
    assert len(found.pieces) == 2
    assert found.area == pytest.approx(math.pi * (0.16 - 0.04 + 0.01), rel=0.02)
    assert not found.contains((0.4, 0.0))


def test_where_nothing_can_be_reached_the_region_is_empty() -> None:
    assert region_where(lambda points: np.zeros(len(points), dtype=bool), GRID).area == 0.0


@pytest.mark.parametrize(("torso_m", "height_m"), [(0.29, 0.79), (0.02, 0.5)])
def test_what_is_left_out_as_too_far_is_out_of_reach(torso_m: float, height_m: float) -> None:
    reach = load_robot("pr2").reach(torso_m, 0.02)
    for arm in range(2):
        asked = partial(takeable, reach, arm, height_m)
        quick, plain = takeable_region(reach, arm, height_m), region_where(asked, Grid.beside(reach.shoulders[arm][:2]))
        assert plain.area > 0.3
        assert quick.difference(plain).area + plain.difference(quick).area == 0.0


def test_both_arms_reach_mirror_images(bare: tuple[Region, ...]) -> None:
    left, right = bare
    mirrored = right.moved(Isometry.reflection(Segment((0.0, 0.0), (1.0, 0.0))))
    # But for what the body and the other arm hinder, which is not quite the same on both sides.
    assert left.difference(mirrored).area + mirrored.difference(left).area < 0.02 * left.area


def test_with_comfort_an_arm_reaches_less_and_nothing_more(
    comfortable: tuple[Region, ...], bare: tuple[Region, ...]
) -> None:
    for little, much in zip(comfortable, bare, strict=True):
        assert 0.3 < little.area < much.area
        assert little.difference(much).area < 0.002


def test_what_is_well_inside_can_be_reached_by_the_arms_joints_and_what_is_far_outside_cannot(
    bare: tuple[Region, ...],
) -> None:
    robot, approaches = load_robot("pr2"), load_robot("pr2").reach(TORSO_M, 0.0).approaches
    assert isinstance(robot, Pr2)
    rotations = np.array([approach.rotation for approach in approaches])
    rng = np.random.default_rng(5)
    for x, y in rng.uniform((0.0, -1.0), (1.2, 1.0), (150, 2)):
        point = np.tile([x, y, HEIGHT_M + 0.02], (len(approaches), 1))
        can = bool(can_reach(robot, 0, point, rotations, TORSO_M).any())
        is_near = bare[0].boundary_distance((x, y)) < 0.01
        if bare[0].contains((x, y)) and not is_near:
            assert can
        elif not can:
            assert is_near or not bare[0].contains((x, y))


def test_whatever_a_plan_picks_up_with_free_hands_lies_in_the_region(comfortable: tuple[Region, ...]) -> None:
    plan = shipped_plan("t-shirt")
    arms = {arm.name: number for number, arm in enumerate(load_robot(plan.task.robot).card.arms)}
    picked = 0
    for number, step in enumerate(plan.steps):
        phases = (segment.phase for segment in required(plan.trajectory).of_step(number))
        held = [phase for phase in phases if any(hand and hand.is_closed for hand in phase.hands)]
        for grip in step.grips:
            x, y, _ = held[0].base[0].to_inner(np.array(grip.pick))
            region = comfortable[arms[grip.arm]]
            assert region.contains((x, y)) or region.boundary_distance((x, y)) < 0.005
            picked += 1
    assert picked >= 5
