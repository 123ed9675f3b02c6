"""The vertices that must be held in the folds of a garment."""

import math

import pytest

from planner import Scene, make_plan
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Pose2
from tests.builders import fold, garment, rectangle_points

STIFF_RAD = math.radians(85.0)


def test_cloth_that_holds_itself_is_taken_where_it_is_furthest_from_the_line() -> None:
    """Else no hand would be asked for, and the fold could be made by nobody."""
    house = ((0.4, 0.3), (0.0, 0.3), (0.0, 0.1), (0.2, 0.0), (0.4, 0.1))
    cloth = garment(house, fold((0.4, 0.2), (0.0, 0.2)), placement=Pose2(-0.65, 0.2, -math.pi / 2))
    covers = FoldSequence.of(cloth).covers(0, STIFF_RAD, 2)
    assert covers.count == 1 and covers.vertices
    assert make_plan(cloth, Scene(support_angle_rad=STIFF_RAD)).status in ("solved", "infeasible")


@pytest.mark.parametrize("angle_rad", [0.0, 0.0873, 0.5, 1.0, STIFF_RAD])
def test_every_fold_is_held_somewhere_however_stiff_the_cloth(angle_rad: float) -> None:
    cloth = garment(rectangle_points(0.4, 0.3), fold((0.4, 0.15), (0.0, 0.15)))
    assert FoldSequence.of(cloth).covers(0, angle_rad, 2).vertices
