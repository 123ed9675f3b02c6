from dataclasses import replace

import pytest

from planner import load_garment
from planner.cloth.garment import DrawnFold, Garment
from planner.planning.robot_task import task_for
from planner.proposals.packet import Packet
from planner.proposals.packet_search import PacketSearch
from planner.proposals.robot_check import DOUBT_EFFORT, Checked, RobotCheck
from planner.proposals.target import Target
from planner.task.task import DEFAULT_ROBOT
from tests.builders import rectangle_points

BIG_TOWEL = replace(load_garment("big-towel"), folds=())


def across(name: str, y_m: float, *, is_low: bool) -> DrawnFold:
    """Return a fold of the big towel along a line across it that moves its lower or its higher part."""
    x0, _, x1, _ = BIG_TOWEL.pattern.bounds
    ends = ((x1, y_m), (x0, y_m)) if is_low else ((x0, y_m), (x1, y_m))
    return DrawnFold(name, "blue", *ends)


def checked(garment: Garment, *folds: DrawnFold, robot: str = DEFAULT_ROBOT) -> Checked:
    robots = RobotCheck(task_for(garment, robot=robot))
    return robots.of(folds, 0, robots.start)


def test_the_far_third_of_a_big_towel_is_out_of_the_robots_reach() -> None:
    near, far = across("near", 0.44, is_low=True), across("far", 0.88, is_low=False)
    assert checked(BIG_TOWEL, near).doubts == 0
    both = checked(BIG_TOWEL, near, far)
    assert (both.doubts, both.effort >= DOUBT_EFFORT) == (1, True)


def test_the_near_third_can_be_rolled_on_after_drags() -> None:
    rolled = checked(BIG_TOWEL, across("near", 0.44, is_low=True), across("on", 0.88, is_low=True))
    assert rolled.doubts == 0
    assert rolled.stand.offset[0] < 0.0  # towards the robot
    assert 0.0 < rolled.effort < DOUBT_EFFORT


@pytest.mark.parametrize(("radius_m", "doubts"), [(0.3, 0), (0.05, 1)])
def test_a_fold_that_needs_more_hands_than_there_are_is_doubted(radius_m: float, doubts: int) -> None:
    outline = [[0.15, 0.0], [0.45, 0.0], [0.6, 0.26], [0.45, 0.52], [0.15, 0.52], [0.0, 0.26]]
    tile = Garment.from_dict(
        {"name": "tile", "outline": outline, "placement": {"x_m": -0.7, "y_m": -0.3, "yaw_rad": 0.0}}
    )
    assert checked(tile, DrawnFold("half", "blue", (0.3, 0.0), (0.3, 0.52), radius_m)).doubts == doubts


@pytest.mark.long  # the map of one arm takes a minute
def test_one_hand_does_not_hold_both_corners_of_a_towel() -> None:
    towel = load_garment("hand-towel")
    assert checked(replace(towel, folds=()), towel.folds[0], robot="ur5e-single").doubts == 1
    assert checked(replace(towel, folds=()), towel.folds[0], robot="ur5e-pair").doubts == 0


@pytest.mark.parametrize("is_asked", [False, True])
def test_what_the_robot_can_do_is_proposed_first(is_asked: bool) -> None:
    skirt = replace(load_garment("skirt"), folds=())
    robot = RobotCheck(task_for(skirt)) if is_asked else None
    first = next(PacketSearch(skirt, Target.of("thirds"), 8, robot=robot).packets())
    assert (checked(skirt, *first.folds).doubts == 0) == is_asked


def test_packets_that_begin_with_blamed_folds_come_later() -> None:
    blanket = Garment.from_dict({"name": "blanket", "outline": rectangle_points(0.6, 0.4)})
    first = next(PacketSearch(blanket, Target.of("20x20cm"), 8).packets())
    search = PacketSearch(blanket, Target.of("20x20cm"), 8)
    search.blame(first.folds[:1])
    spared = next(search.packets())
    assert spared.folds[0] != first.folds[0]
    assert spared.way == first.way


def sketched(garment: Garment) -> tuple[PacketSearch, Packet]:
    """Return a search that asks the robot, and what it is given to begin with where that takes long."""
    sketch = Packet.of(garment)
    search = PacketSearch(garment, Target.of("shelf"), 8, robot=RobotCheck(task_for(garment)))
    search.sketched = iter((sketch,))
    return search, sketch


def test_sketches_come_next_where_the_robot_cannot_do_what_came_first() -> None:
    search, sketch = sketched(replace(load_garment("hand-towel"), folds=()))
    packets = search.packets()
    first = next(packets)
    assert first is not sketch
    search.blame(first.folds[:1])
    search.sketched = iter((replace(sketch, folds=first.folds), sketch))
    assert next(packets) is sketch  # the other begins as what the robot cannot do
    assert next(packets) is not sketch


def test_sketches_come_first_where_the_robot_must_be_asked_about_many() -> None:
    search, sketch = sketched(BIG_TOWEL)
    assert next(search.packets()) is sketch
