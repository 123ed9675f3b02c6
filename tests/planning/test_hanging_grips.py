"""Hanging cloth is gripped and released a little outside the table's edge: fingers do not fit into the top."""

import math

import pytest

from planner import Garment, Plan, Scene, make_plan
from planner.geometry.pose import Pose2
from planner.motion.timeline import Timeline
from tests.builders import fold, garment, rectangle_points
from tests.replay.checker import check
from tests.replay.joints import require_clear, require_speeds

CLEAR_M = Scene().edge_clear_m


def towel(hanging_m: float, line_m: float, length_m: float = 0.5) -> Garment:
    """Return a towel whose near end hangs over the near edge, and the fold that brings it back, `line_m` from there."""
    over = fold((0.3, line_m), (0.0, line_m))
    return garment(rectangle_points(0.3, length_m), over, placement=Pose2(-0.8 - hanging_m, 0.15, -math.pi / 2))


def aside(hanging_m: float, x_m: float, side: float) -> Garment:
    """Return a towel over the edge at the robot's left (side 1) or right (-1), its middle at `x_m`."""
    line_m = hanging_m + 0.08
    over = fold((0.3, line_m), (0.0, line_m))
    placement = Pose2(x_m + side * 0.15, side * (0.49 + hanging_m), math.pi if side > 0 else 0.0)
    return garment(rectangle_points(0.3, 0.6), over, placement=placement)


def required(cloth: Garment, scene: Scene | None = None) -> Plan:
    """Require a plan that replays and in which nothing touches anything; return it."""
    plan = make_plan(cloth, scene, time_limit_s=60.0)
    assert plan.is_solved, plan.reasons
    check(cloth.to_dict(), plan.scene.to_dict(), plan.to_dict())
    require_speeds(Timeline.of(plan))
    require_clear(Timeline.of(plan), plan.scene.table, every_s=0.37)
    return plan


def test_the_fold_of_figure_4_brings_back_what_hangs() -> None:
    (primitive,) = required(towel(0.04, 0.12)).primitives
    for grip, y in zip(primitive.grips, (0.15, -0.15), strict=True):
        assert grip.pick == pytest.approx((-0.8 - CLEAR_M, y, -0.02))
        assert grip.place == pytest.approx((-0.8 - 0.04 + 0.24, y, 0.02))


@pytest.mark.parametrize(
    ("hanging_m", "length_m"),
    [
        pytest.param(0.01, 0.5, marks=pytest.mark.long),
        pytest.param(0.02, 0.5, marks=pytest.mark.long),
        pytest.param(0.03, 0.5, marks=pytest.mark.long),
        (0.1, 0.5),
        pytest.param(0.2, 1.2, marks=pytest.mark.long),
    ],
)
def test_it_does_so_however_deep_the_cloth_hangs(hanging_m: float, length_m: float) -> None:
    plan = required(towel(hanging_m, hanging_m + 0.08, length_m))
    assert [primitive.kind for primitive in plan.primitives] == ["fold"]


@pytest.mark.long
def test_it_does_so_as_deep_as_the_arms_reach() -> None:
    # Arms that reach so far down turn so much on their way that they take longer than an arm motion.
    plan = make_plan(towel(0.4, 0.48, 1.2), time_limit_s=60.0)
    assert plan.is_solved, plan.reasons
    require_speeds(Timeline.of(plan))
    require_clear(Timeline.of(plan), plan.scene.table, every_s=0.37)


@pytest.mark.long
@pytest.mark.parametrize("x_m", [0.6, -0.1])
def test_so_does_it_at_the_sides_and_the_mirrored_task_has_the_mirrored_plan(x_m: float) -> None:
    left, right = (required(aside(0.1, x_m, side)) for side in (1.0, -1.0))
    assert left.cost_s == pytest.approx(right.cost_s)
    there = {grip.arm: grip.pick for grip in left.primitives[-1].grips}
    here = {grip.arm: grip.pick for grip in right.primitives[-1].grips}
    for arm, other in (("left", "right"), ("right", "left")):
        x, y, z = there[arm]
        assert here[other] == pytest.approx((x, -y, z))


@pytest.mark.parametrize("hanging_m", [pytest.param(0.01, marks=pytest.mark.long), 0.03])
def test_cloth_is_laid_down_over_the_near_edge_though_most_ways_have_fingers_in_the_top(hanging_m: float) -> None:
    # The line is 0.1 m from the edge. Within the default cone most ways come from the side.
    over = fold((0.0, 0.08), (0.3, 0.08))
    cloth = garment(rectangle_points(0.3, 0.18 + hanging_m), over, placement=Pose2(-0.78, 0.15, -math.pi / 2))
    plan = required(cloth)
    assert [grip.place[0] for grip in plan.primitives[-1].grips] == pytest.approx([-0.8 - CLEAR_M] * 2)


def test_cloth_may_be_laid_down_over_the_edge() -> None:
    # The far 0.16 m come over the line 0.1 m from the edge: their end hangs 0.06 m. Hands that must come from outside
    # the cloth, from the side, would have a finger in the top.
    over = fold((0.0, 0.08), (0.3, 0.08))
    cloth = garment(rectangle_points(0.3, 0.24), over, placement=Pose2(-0.78, 0.15, -math.pi / 2))
    (primitive,) = required(cloth, Scene(approach_cone_rad=math.pi)).primitives
    assert [grip.place[0] for grip in primitive.grips] == pytest.approx([-0.8 - CLEAR_M] * 2)
    assert [grip.place[2] for grip in primitive.grips] == pytest.approx([-0.04] * 2)
