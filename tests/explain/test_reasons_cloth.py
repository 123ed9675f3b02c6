"""Cloth that would not stay, or lies where it cannot be folded: provoked, worked out by hand, and fixed."""

from dataclasses import replace

import pytest

from planner import Scene, make_plan
from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.pose import Point2, Pose2
from planner.geometry.table import Table
from planner.task.reason import Code
from tests.builders import fold, garment, rectangle_points
from tests.planning.provoked import BACK, HAMMER_SCENE, but_for_collisions, hammer, is_gone, refused
from tests.required import required

BEHIND = Scene(stations=(("front", Pose2(-1.2, 0.0, 0.0)),), back_off_max_m=0.0)
"""A scene in which the robot stands still, 0.4 m from the table's near edge at x = -0.8 m."""


def test_a_fold_after_which_too_much_hangs_names_the_friction_that_would_hold_it() -> None:
    # 0.4 m wide, from x = -0.9 to -0.6. Folded at -0.75 the far half lies on the near one, from -0.9 to -0.75: of both
    # layers 0.1 m hang and 0.05 m lie. So 2 x 0.4 x 0.1 = 0.08 m^2 pull and half of that holds: friction 2.
    towel = _towel(fold((0.0, 0.15), (0.4, 0.15)), 0.3, x_m=-0.9)
    reason = but_for_collisions(refused(towel, BEHIND))
    assert (reason.fold, reason.code) == (0, Code.SLIPS)
    assert reason.needed_friction == pytest.approx(2.0)
    assert "0.080 m^2 of cloth (66.7%) hangs over the near edge and 0.040 m^2 (33.3%) lies" in reason.message
    assert "the friction is 1.00, 2.00 would hold it" in reason.message
    needed = required(reason.needed_friction)
    assert is_gone(reason, make_plan(towel, replace(BEHIND, friction=needed), time_limit_s=60.0))
    assert not is_gone(reason, refused(towel, replace(BEHIND, friction=needed - 0.01)))


def test_a_fold_that_would_cover_a_corner_says_how_far_it_covers_it() -> None:
    # The table ends at x = -0.5 and y = 0.3. The cloth hangs from -0.55 to -0.5; folded over y = 0.2 its part below
    # lands between y = 0.2 and 0.4, and the corner is 0.05 m from its edge at x = -0.55.
    scene = Scene(
        stations=(("front", Pose2(-1.0, 0.0, 0.0)),), back_off_max_m=0.0, table=Table(depth_m=1.0, width_m=0.6)
    )
    over = fold((0.2, 0.2), (0.0, 0.2))
    cloth = garment(rectangle_points(0.2, 0.25), over, placement=Pose2(-0.55, 0.0, 0.0))
    reason = but_for_collisions(refused(cloth, scene))
    assert (reason.fold, reason.code) == (0, Code.NOT_A_G_STATE)
    assert reason.short_by_m == pytest.approx(0.05)
    assert reason.point == pytest.approx((-0.5, 0.3, 0.0))
    assert (
        "afterwards the cloth covers the table's corner at (-0.500, 0.300) m, which is 0.05 m inside it"
        in reason.message
    )
    fixed = replace(cloth, placement=cloth.placement.moved(required(reason.short_by_m) + 1e-4, 0.0))
    assert is_gone(reason, make_plan(fixed, scene, time_limit_s=60.0))


def test_a_flap_that_would_hang_by_its_neck_says_which_corner_is_loose() -> None:
    # The hammer's head is 0.3 m wide, its neck 0.1 m. Folded over y = 0.1 the head lands from y = -0.3 to -0.2;
    # the edge is at y = -0.15, so the head's upper corners hang 0.05 m below it with nothing above them.
    reason, *dragged = refused(hammer(), HAMMER_SCENE).reasons
    assert (reason.fold, reason.code) == (0, Code.NOT_A_G_STATE)
    assert reason.short_by_m == pytest.approx(0.05, abs=1e-4)
    assert "hangs over the near edge and nothing holds its corner at" in reason.message
    assert "-0.20) m of the garment, 0.05 m beyond the edge" in reason.message
    # Dragged towards the robot it would only hang further.
    assert all("the cloth dragged by" in r.message for r in dragged if r.set != reason.set)
    fixed = replace(hammer(), placement=hammer().placement.moved(required(reason.short_by_m) + 1e-4, 0.0))
    assert is_gone(reason, make_plan(fixed, HAMMER_SCENE, time_limit_s=60.0))


def test_a_part_that_reaches_behind_the_lines_extension_says_how_far() -> None:
    # A hook: an arm to the right of x = 0.4, bent down, its tip back to x = 0.3.
    def hook(tip_m: float) -> Garment:
        outline: list[Point2] = [(0, 0.2), (0.4, 0.2), (0.4, 0.3), (0.5, 0.3), (0.5, 0.1), (tip_m, 0.1)]
        outline += [(tip_m, 0), (0.6, 0), (0.6, 0.4), (0, 0.4)]
        return garment(outline, fold((0.4, 0.4), (0.4, 0.3), name="hook"))

    (reason, *_) = refused(hook(0.3)).reasons
    assert (reason.fold, reason.code) == (0, Code.NOT_A_G_STATE)
    assert reason.short_by_m == pytest.approx(0.1)
    assert "reaches 0.10 m behind the line's extension" in reason.message
    assert "turn or lengthen the line, or fold that part by itself first" in reason.message
    assert is_gone(reason, make_plan(hook(0.3 + required(reason.short_by_m)), time_limit_s=60.0))


def test_a_line_beside_the_table_says_how_far_it_is_from_it() -> None:
    # From x = -1.0 to -0.5; the line is at -0.9, 0.1 m beyond the edge. 0.2 m hang and 0.3 m lie.
    towel = _towel(fold((0.4, 0.1), (0.0, 0.1)), 0.5, x_m=-1.0)
    (reason,) = refused(towel, BEHIND).reasons
    assert (reason.fold, reason.code) == (0, Code.LINE_OFF_TABLE)
    assert reason.short_by_m == pytest.approx(0.1)
    assert "beyond the table's edge, by 0.10 m" in reason.message
    nearer = replace(towel, placement=towel.placement.moved(required(reason.short_by_m) + 1e-4, 0.0))
    assert is_gone(reason, make_plan(nearer, BEHIND, time_limit_s=60.0))
    not_yet = replace(towel, placement=towel.placement.moved(required(reason.short_by_m) - 1e-3, 0.0))
    assert not is_gone(reason, refused(not_yet, BEHIND))


def test_cloth_that_covers_a_corner_at_the_start_says_so_of_no_fold() -> None:
    over = fold((0.4, 0.2), (0.0, 0.2))
    cloth = garment(rectangle_points(0.4, 0.4), over, placement=Pose2(0.6, 0.28, 0.0))
    (reason,) = refused(cloth).reasons
    # The corner (0.8, 0.49) is 0.2 m from the cloth's left and right edge and 0.68 - 0.49 = 0.19 m from its upper one.
    assert (reason.fold, reason.code) == (None, Code.NOT_A_G_STATE)
    assert reason.short_by_m == pytest.approx(0.19)
    assert reason.point == pytest.approx((0.8, 0.49, 0.0))
    assert "as the garment lies at the start, the cloth covers the table's corner" in reason.message
    fixed = replace(cloth, placement=cloth.placement.moved(0.0, -required(reason.short_by_m) - 1e-4))
    assert all(r.fold is not None for r in make_plan(fixed, time_limit_s=60.0).reasons)


@pytest.mark.long
def test_cloth_that_slips_at_the_start_says_what_hangs_and_what_lies() -> None:
    # 0.4 m wide, from y = 0.39 to 1.19 where the table ends at 0.49: 0.1 m lie and 0.7 m hang.
    over = fold((0.4, 0.4), (0.0, 0.4))
    cloth = garment(rectangle_points(0.4, 0.8), over, placement=Pose2(-0.2, 0.39, 0.0))
    reason, *others = refused(cloth).reasons
    assert (reason.fold, reason.code) == (None, Code.SLIPS)
    assert reason.needed_friction == pytest.approx(7.0)
    assert {(other.fold, other.code, other.set) for other in others} == {(0, Code.OUT_OF_REACH, reason.set)}
    assert "0.280 m^2 of cloth (87.5%) hangs over the left edge and 0.040 m^2 (12.5%) lies" in reason.message
    held = make_plan(cloth, Scene(friction=required(reason.needed_friction) + 1e-3), time_limit_s=60.0)
    assert all(r.fold is not None for r in held.reasons)


@pytest.mark.long
def test_cloth_beside_the_table_says_how_far_it_is_from_it() -> None:
    cloth = garment(rectangle_points(0.4, 0.4), fold((0.4, 0.2), (0.0, 0.2)), placement=Pose2(1.0, -0.2, 0.0))
    (reason,) = refused(cloth).reasons
    # The table ends at x = 0.8.
    assert (reason.fold, reason.code) == (None, Code.NOT_A_G_STATE)
    assert reason.short_by_m == pytest.approx(0.2)
    assert "nothing of the cloth lies on the table: it is 0.20 m beside it" in reason.message


def test_a_sheet_larger_than_the_table_is_told_so() -> None:
    sheet = garment(rectangle_points(3.0, 3.0), fold((3.0, 1.5), (0.0, 1.5)))
    (reason,) = refused(sheet).reasons
    assert reason.message.endswith("it is too large for the table")


def _towel(line: DrawnFold, length_m: float, x_m: float) -> Garment:
    """Return a towel 0.4 m wide, its near edge at x, its y away from `front`."""
    return garment(rectangle_points(0.4, length_m), line, placement=Pose2(x_m, 0.2, BACK))
