"""Cloth that hangs equally over two opposite edges: nothing pulls at it, however smooth the table."""

import math

import pytest

from planner import Scene, make_plan
from planner.geometry.pose import Pose2
from tests.builders import fold, garment, rectangle_points
from tests.required import required

SMOOTH = Scene(friction=0.0)
TOO_FAINT_M = 2e-5
"""The offset by which cloth 0.2 m wide is out of balance by less than a sliver (m)."""


@pytest.mark.parametrize("off_m", [0.0, TOO_FAINT_M, -TOO_FAINT_M])
def test_a_balanced_strip_is_folded_lengthwise_on_a_smooth_table(off_m: float) -> None:
    # 1.2 m across a table 0.98 m wide: 0.11 m hang on each side, before the fold along it and after.
    along = fold((1.2, 0.1), (0.0, 0.1))
    strip = garment(rectangle_points(1.2, 0.2), along, placement=Pose2(-0.6, 0.6 + off_m, -math.pi / 2))
    assert make_plan(strip, SMOOTH, time_limit_s=60.0).is_solved


def test_out_of_balance_it_slips_and_says_how_little_would_hold_it() -> None:
    # 1 mm to one side: 0.111 and 0.109 m hang, 0.98 m lie.
    strip = garment(
        rectangle_points(1.2, 0.2), fold((1.2, 0.1), (0.0, 0.1)), placement=Pose2(-0.6, 0.601, -math.pi / 2)
    )
    (reason,) = make_plan(strip, SMOOTH, time_limit_s=60.0).reasons
    assert reason.needed_friction == pytest.approx(0.002 / 0.98, rel=1e-3)
    assert make_plan(strip, Scene(friction=required(reason.needed_friction)), time_limit_s=60.0).is_solved
