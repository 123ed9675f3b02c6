"""The check of a garment: whether two grippers can hold all folds, and if not, at which corners."""

import math
import random

import pytest

from planner.cloth.garment import DrawnFold
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.cloth.must_hold import must_hold
from planner.errors import FoldError, GarmentError
from planner.explain.garment_check import Support, check_garment, vertex_checks
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2
from planner.task.scene import Scene
from tests.builders import fold, garment, rectangle_points, star
from tests.required import required


@pytest.mark.parametrize("name", shipped_garment_names())
def test_two_grippers_can_hold_every_fold_of_a_shipped_garment(name: str) -> None:
    checked = check_garment(load_garment(name))
    assert checked.is_holdable
    assert all(1 <= required(one.grips_needed) <= 2 and one.problem is None for one in checked.folds)


def test_a_fold_says_what_must_be_held_and_where() -> None:
    towel = garment(rectangle_points(0.4, 0.3), fold((0.0, 0.1), (0.4, 0.1)))
    (half,) = check_garment(towel).folds
    # Left of the line is the upper part: its two top corners.
    assert sorted(half.must_hold) == [(0.0, 0.3), (0.4, 0.3)]
    assert half.grips == ((0.0, 0.3), (0.4, 0.3)) and half.grips_needed == 2


def test_without_a_scene_it_is_the_one_that_suits_the_robot() -> None:
    assert check_garment(load_garment("hand-towel"), robot="ur5e-pair").is_holdable


def test_the_outline_is_measured() -> None:
    checked = check_garment(garment(rectangle_points(0.4, 0.3, x_m=1.0), fold((1.0, 0.1), (1.4, 0.1))))
    assert checked.points == 4 and checked.size_m == pytest.approx((0.4, 0.3))
    assert checked.area_m2 == pytest.approx(0.12)


def test_every_corner_says_what_holds_it_or_that_nothing_does() -> None:
    # Folded up over y = 0, seen with "above" upwards: a step on the left, an overhang with a notch on the right.
    outline: tuple[Point2, ...] = (
        (0.0, -0.2),
        (0.6, -0.2),
        (0.6, 0.0),
        (0.7, 0.2),
        (0.6, 0.3),
        (0.5, 0.2),
        (0.4, 0.3),
        (0.2, 0.3),
        (0.2, 0.1),
    )
    outline += ((0.0, 0.1),)
    (checked,) = check_garment(garment(outline, fold((0.0, 0.0), (0.6, 0.0)))).folds
    why = {vertex.point: vertex.support for vertex in checked.vertices}
    assert why == {
        (0.0, 0.0): Support.ON_THE_LINE,
        (0.6, 0.0): Support.ON_THE_LINE,
        # The hull leads from (0.7, 0.2) by (0.6, 0.3) and (0.2, 0.3) to (0.0, 0.1), and above none of them is there
        # cloth; (0.4, 0.3) lies on one of its sides.
        (0.7, 0.2): Support.HANGS_FREELY,
        (0.6, 0.3): Support.HANGS_FREELY,
        (0.5, 0.2): Support.WITHIN_THE_HULL,
        (0.4, 0.3): Support.WITHIN_THE_HULL,
        (0.2, 0.3): Support.HANGS_FREELY,
        (0.2, 0.1): Support.WITHIN_THE_HULL,
        (0.0, 0.1): Support.HANGS_FREELY,
    }


def test_an_overhang_hangs_from_the_cloth_above_it() -> None:
    # A kite that leans out: straight above its right corner's lower neighbour there is cloth.
    outline = ((0.0, -0.2), (0.4, -0.2), (0.4, 0.0), (0.6, 0.1), (0.6, 0.3), (0.0, 0.3))
    (checked,) = check_garment(garment(outline, fold((0.0, 0.0), (0.4, 0.0)))).folds
    why = {vertex.point: vertex.support for vertex in checked.vertices}
    assert why[(0.6, 0.1)] is Support.CLOTH_ABOVE
    assert why[(0.6, 0.3)] is Support.HANGS_FREELY


@pytest.mark.parametrize(("flare_deg", "support"), [(4.0, Support.CLOTH_NEARLY_ABOVE), (6.0, Support.HANGS_FREELY)])
def test_an_edge_that_flares_by_less_than_the_support_angle_is_nearly_above(flare_deg: float, support: Support) -> None:
    # The right edge leans inwards going up: straight above its lower corner there is no cloth, but 4 degrees beside it.
    lean = 0.3 * math.tan(math.radians(flare_deg))
    outline: tuple[Point2, ...] = ((0.0, -0.2), (0.4, -0.2), (0.4, 0.0), (0.5, 0.0), (0.5 - lean, 0.3), (0.0, 0.3))
    outline = tuple((x, y + 0.05) if y >= 0.0 and x > 0.4 else (x, y) for x, y in outline)
    cloth = garment(outline, fold((0.0, 0.0), (0.4, 0.0)))
    (checked,) = check_garment(cloth, Scene(support_angle_rad=math.radians(5.0))).folds
    assert {v.point: v.support for v in checked.vertices}[(0.5, 0.05)] is support


def test_what_is_said_to_hang_freely_is_what_must_be_held() -> None:
    rng, looked_at = random.Random(6), 0
    while looked_at < 40:
        outline = star(rng, rng.randint(5, 25))
        start, end = rng.sample(outline, 2)
        try:
            sequence = FoldSequence.of(garment(outline, fold(start, end)))
        except (FoldError, GarmentError):
            continue
        looked_at += 1
        line, part = sequence.folds[0].line, sequence.folded(0, 0).moving
        angle = rng.choice((0.0, math.radians(5.0)))
        free = [v.point for v in vertex_checks(part, line, angle) if v.must_be_held]
        assert free == [tuple(p) for p in must_hold(part, line.left, (line,), angle)]


def test_three_corners_far_apart_cannot_be_held_by_two_grippers() -> None:
    # A comb of three long teeth: each tip must be held, and they are 0.3 m apart.
    points = [(0, 0), (0.7, 0), (0.7, 0.5), (0.6, 0.5), (0.6, 0.2), (0.4, 0.2), (0.4, 0.6), (0.3, 0.6)]
    points += [(0.3, 0.2), (0.1, 0.2), (0.1, 0.5), (0, 0.5)]
    checked = check_garment(garment(points, fold((0.0, 0.1), (0.7, 0.1))))
    assert not checked.is_holdable
    assert checked.folds[0].grips_needed is None and checked.folds[0].grips == ()
    problem = required(checked.folds[0].problem)
    assert "must be held" in problem and "a grip radius of" in problem


def test_two_grips_nearer_than_two_hands_can_be_are_a_problem() -> None:
    # The ribbon is 0.08 m wide and a grip holds 0.03 m: two grips, 0.08 m apart.
    ribbon = garment(rectangle_points(0.08, 0.3), fold((0.08, 0.15), (0.0, 0.15), radius_m=0.03))
    checked = check_garment(ribbon)
    assert checked.folds[0].grips_needed == 2 and not checked.is_holdable
    assert "0.080 m apart" in required(checked.folds[0].problem)


def test_a_red_fold_is_held_with_what_the_fold_before_it_holds() -> None:
    # The near half comes over; what of it lies beyond y = 0.35 goes back. Its corners are those held already.
    half, back = fold((0.4, 0.2), (0.0, 0.2)), fold((0.0, 0.35), (0.4, 0.35), "red")
    towel = check_garment(garment(rectangle_points(0.4, 0.5), half, back))
    assert towel.is_holdable
    assert [one.kind for one in towel.folds] == ["blue", "red"]
    assert sorted(towel.folds[1].grips) == [pytest.approx((0.0, 0.4)), pytest.approx((0.4, 0.4))]


def test_a_red_fold_that_no_hand_holds_any_more_is_a_problem() -> None:
    # The house's roof, folded up, is held at an eave and amid a slope; its tip is half a slope from there.
    outline = ((0.4, 0.3), (0.0, 0.3), (0.0, -0.1), (0.2, -0.2), (0.4, -0.1))
    roof = fold((0.4, 0.0), (0.0, 0.0), name="roof", radius_m=0.112)

    def tip(radius_m: float) -> DrawnFold:
        return fold((0.04, 0.12), (0.36, 0.12), "red", name="tip", radius_m=radius_m)

    checked = check_garment(garment(outline, roof, tip(0.08)))
    assert [one.problem is None for one in checked.folds] == [True, False]
    assert "the nearest hand that still holds from fold 0 'roof' is 0.11 m away" in required(checked.folds[1].problem)
    assert check_garment(garment(outline, roof, tip(0.112))).is_holdable


def test_the_check_is_json() -> None:
    towel = garment(rectangle_points(0.4, 0.3), fold((0.0, 0.1), (0.4, 0.1), name="up"))
    found = check_garment(towel).to_dict()
    assert found["outline"] == {"points": 4, "size_m": [0.4, 0.3], "area_m2": pytest.approx(0.12)}
    (up,) = found["folds"]
    assert (up["name"], up["kind"], up["grips_needed"], up["problem"]) == ("up", "blue", 2, None)
    assert {tuple(v["point"]): (v["must_be_held"], v["why"]) for v in up["vertices"]} == {
        (0.0, 0.1): (False, "on_the_line"),
        (0.4, 0.1): (False, "on_the_line"),
        (0.4, 0.3): (True, "hangs_freely"),
        (0.0, 0.3): (True, "hangs_freely"),
    }
