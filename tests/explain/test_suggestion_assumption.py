"""What would have to be true of the world: the least of each assumption, alone or together."""

import math

import pytest

from planner import Scene, make_plan
from planner.explain.suggestion_assumption import comforts, frictions, grip_radii, together
from planner.geometry.pose import Pose2
from tests.builders import fold, garment, rectangle_points
from tests.explain.proven_search import asked, proven
from tests.planning.provoked import planned_with


def test_the_friction_that_is_suggested_is_the_least_in_hundredths() -> None:
    # Folded over x = 0.3 of 1.2 m across the table, 0.11 m hang and 1.09 m of layers lie: 0.1009 would do.
    strip = garment(
        rectangle_points(1.2, 0.05), fold((0.3, 0.0), (0.3, 0.05)), placement=Pose2(-0.6, 0.6, -math.pi / 2)
    )
    smooth = Scene(friction=0.0)
    for reasons in (make_plan(strip, smooth, time_limit_s=60.0).reasons, ()):
        found = next(proven(frictions(asked(strip, smooth), reasons)))
        assert found.change["scene"]["friction"] == pytest.approx(0.11)
        assert found.plan.is_solved


def test_the_grip_radius_that_is_suggested_is_the_least_in_whole_millimetres() -> None:
    # The corners of a ribbon's end are 0.05 m apart, too near for two hands; one between them needs 0.025 m.
    line = fold((0.05, 0.15), (0.0, 0.15), radius_m=0.01)
    ribbon = garment(rectangle_points(0.05, 0.3), line, placement=Pose2(-0.7, 0.21, -math.pi / 2))
    known = make_plan(ribbon, time_limit_s=60.0)
    for reasons in (known.reasons, ()):
        found = next(proven(grip_radii(asked(ribbon), (0,), reasons)))
        assert found.change["garment"]["folds"][0]["grip_radius_m"] == pytest.approx(0.025)


def test_assumptions_that_are_enough_only_together_are_suggested_together_each_the_least() -> None:
    # A ribbon that hangs over the table's edge, and whose corners are too near for two hands.
    line = fold((0.3, 0.0), (0.3, 0.05), radius_m=0.01)
    ribbon = garment(rectangle_points(1.2, 0.05), line, placement=Pose2(-0.6, 0.6, -math.pi / 2))
    task = asked(ribbon, Scene(friction=0.0))
    for alone in (comforts(task), frictions(task, ()), grip_radii(task, (0,), ())):
        with pytest.raises(StopIteration):
            next(proven(alone))
    found = next(proven(together(task, (0,))))
    assert found.is_assumption
    assert found.change["scene"]["friction"] == pytest.approx(0.11)
    assert found.change["garment"]["folds"][0]["grip_radius_m"] == pytest.approx(0.025)
    assert "comfort_radius_m" not in found.change
    assert found.message.startswith("Assume a friction coefficient of 0.11, not 0 and assume that one grip holds")
    assert planned_with(found.change, ribbon, task.scene).is_solved


def test_assumptions_of_which_one_is_enough_are_not_suggested_together() -> None:
    line = fold((0.05, 0.15), (0.0, 0.15), radius_m=0.01)
    ribbon = garment(rectangle_points(0.05, 0.3), line, placement=Pose2(-0.7, 0.21, -math.pi / 2))
    with pytest.raises(StopIteration):
        next(proven(together(asked(ribbon), (0,))))
