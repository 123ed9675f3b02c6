"""The choice and order of reasons: each of them, fixed alone, would lead further."""

import numpy as np
import pytest

from planner import Garment, Scene, load_garment
from planner.explain.reasons import reasons
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.planning import path_search as planning
from planner.primitives.obstacle import Obstacle, situation
from planner.primitives.state import State
from planner.task.reason import Code
from planner.words.catalogue import worded
from tests.builders import fold, garment, rectangle_points
from tests.planning.found import found_plan
from tests.planning.provoked import (
    BACK,
    COMFORT_M,
    FRONT,
    FURTHEST_X,
    HAMMER_SCENE,
    HOUSE,
    LEVEL_M,
    fixed,
    hammer,
    is_gone,
    met,
    refused,
    strip,
)
from tests.replay.planned import shipped_plan
from tests.required import required

START = State(0, (0.0, 0.0), 0, 0)
SLIPPING = {"hanging_m2": {"near": 0.03}, "lying_m2": 0.01, "friction": 1.0, "needed_friction": 3.0}


def test_causes_of_one_fold_come_with_the_smallest_repair_first() -> None:
    # A strip of 0.539 m whose far end is 0.05 m out of reach at the start. Dragged by 0.1 m it is in reach, but then
    # folded at 0.25 m from its far end 0.08 + 0.041 m of it hang and 0.539 - 0.121 lie: that takes a friction of 0.29,
    # and there is 0.25. Without the fold 0.08 hang and 0.459 lie: that holds.
    far_x, near_x, edge_x = FURTHEST_X - COMFORT_M + 0.05, -0.7, -0.72
    cloth = strip(far_x, far_x - near_x, 0.25)
    hanging = (edge_x - (near_x - 0.1)) + (edge_x - (far_x - 0.1 - 0.5))
    needed = hanging / (far_x - near_x - hanging)
    assert needed == pytest.approx(0.29, abs=0.002)
    scene = Scene(stations=FRONT, table=Table(height_m=LEVEL_M, depth_m=-2.0 * edge_x), friction=0.25)
    slip, reach = (
        next(r for r in refused(cloth, scene).reasons if r.code is code) for code in (Code.SLIPS, Code.OUT_OF_REACH)
    )
    assert slip.set != reach.set
    assert slip.needed_friction == pytest.approx(needed, abs=1e-3)
    assert reach.short_by_m == pytest.approx(0.05, abs=0.0015)
    assert "the cloth dragged by (-0.10, 0.00) m" in slip.message and "dragged" not in reach.message


@pytest.mark.parametrize(("friction", "codes"), [(0.08, ["out_of_reach", "slips"]), (0.12, ["slips", "out_of_reach"])])
def test_of_causes_each_of_which_is_enough_the_smallest_repair_comes_first(friction: float, codes: list[str]) -> None:
    # A strip of 0.619 m, folded at 0.1 m from its far end, which is 0.05 m out of reach as it lies. Dragged by 0.1 m it
    # is within reach, but 0.08 m of it hang and 0.539 lie: that takes a friction of 0.148.
    far_x, near_x = FURTHEST_X - COMFORT_M + 0.05, -0.78
    cloth = strip(far_x, far_x - near_x, 0.1)
    scene = Scene(stations=FRONT, table=Table(height_m=LEVEL_M), friction=friction)
    found = refused(cloth, scene).reasons
    assert [(r.code, r.set) for r in found] == [*zip(codes, (0, 1), strict=True)]
    slip, reach = sorted(found, key=lambda r: r.needed_friction is None)
    assert slip.needed_friction == pytest.approx(0.08 / (far_x - near_x - 0.08), rel=1e-3)
    assert reach.short_by_m == pytest.approx(0.05, abs=0.0015)
    assert (required(reach.short_by_m) < required(slip.needed_friction) - friction) == (found[0] is reach)


def test_what_does_not_stand_alone_in_the_way_is_no_reason() -> None:
    # Dragged by 0.3 m the hammer's line is beside the table; but then its head would be loose too, or it would slip.
    answer = met(hammer(), HAMMER_SCENE)
    assert set(answer.context.obstacles.codes(0)) >= {Code.NOT_A_G_STATE, Code.SLIPS, Code.LINE_OFF_TABLE}
    assert [r.code for r in answer.plan.reasons if r.code is not Code.COLLISION] == [Code.NOT_A_G_STATE, Code.SLIPS]


def test_where_two_things_stand_in_every_way_both_are_named() -> None:
    # At -1.4 m the robot is too far from the far edge, and after the fold 2 x 0.1 m would hang and 2 x 0.05 m lie.
    towel = garment(rectangle_points(0.4, 0.3), fold((0.0, 0.15), (0.4, 0.15)), placement=Pose2(-0.9, 0.2, BACK))
    scene = Scene(stations=(("front", Pose2(-1.4, 0.0, 0.0)),), back_off_max_m=0.0)
    both = [reason for reason in refused(towel, scene).reasons if reason.code is not Code.COLLISION]
    assert {r.code for r in both} == {Code.SLIPS, Code.OUT_OF_REACH}
    rough = Scene(stations=scene.stations, back_off_max_m=0.0, friction=2.0)
    assert [r.code for r in refused(towel, rough).reasons][:1] == [Code.OUT_OF_REACH]
    assert all(r.code is not Code.SLIPS for r in refused(towel, rough).reasons)


@pytest.mark.long
def test_folds_that_wait_come_last_and_name_what_they_wait_for() -> None:
    found = shipped_plan("tie-halved").reasons
    assert [(r.fold, r.code) for r in found] == [
        (0, Code.OUT_OF_REACH),
        (1, Code.WAITS_FOR_FOLD),
        (2, Code.WAITS_FOR_FOLD),
    ]
    assert found[1].message == "fold 1 'half again': waits for fold 0 'half', which cannot be done"
    # The last waits for the middle one, but what has to be fixed is the first.
    assert found[2].message == "fold 2 'and again': waits for fold 0 'half', which cannot be done"


def test_a_fold_that_waits_is_possible_once_the_other_is() -> None:
    # The scarf, begun with the quarter instead of the half, can be folded.
    waiting = shipped_plan("scarf-halved").reasons[1]
    assert (waiting.fold, waiting.code) == (1, Code.WAITS_FOR_FOLD)
    assert is_gone(waiting, shipped_plan("scarf"))


def test_only_what_depends_on_a_blocked_fold_waits() -> None:
    # Of the T-shirt's folds 0 -> 2 -> 4 <- 3 <- 1 the left side and the last wait for the left sleeve.
    context = found_plan(load_garment("t-shirt"), max_expanded=1).context
    found = reasons(context, (), [0])
    assert [(r.fold, r.code) for r in found if r.fold != 0] == [(2, Code.WAITS_FOR_FOLD), (4, Code.WAITS_FOR_FOLD)]


def test_a_fold_that_was_not_come_to_yet_is_not_to_blame(monkeypatch: pytest.MonkeyPatch) -> None:
    # Flap 0 is out of reach from where the robot begins, but not from the other side. Roof 1 needs three hands. The
    # search ends with its first expansion, when only that much is known.
    monkeypatch.setattr(planning, "LOOK_ALONE_AFTER", 1)
    flap = fold((0.0, 0.25), (0.4, 0.25), name="flap")
    roof = fold((0.4, 0.0), (0.0, 0.0), name="roof", radius_m=0.08)
    cloth = garment(HOUSE, flap, roof, placement=Pose2(0.2, 0.2, BACK))
    answer = found_plan(cloth, time_limit_s=60.0).plan
    assert answer.status == "infeasible"
    assert answer.statistics.expanded == 1
    assert [(r.fold, r.code) for r in answer.reasons] == [(1, Code.TOO_MANY_GRIPS)]


def test_hands_that_do_not_suffice_are_no_reason_where_what_is_held_only_lacks_reach() -> None:
    context = found_plan(strip(FURTHEST_X - COMFORT_M + 0.05, 0.3, 0.1), fixed()).context
    context.obstacles.note(Obstacle(0, Code.TOO_MANY_GRIPS, None, 1.0, START))
    found = reasons(context, {situation(START)}, ())
    assert [r.code for r in found] == [Code.OUT_OF_REACH]


def test_folds_that_exclude_each_other_are_blocked_where_most_are_done() -> None:
    # Neither of two flaps waits for the other, and each was done, but never both.
    flaps = fold((0.1, 0.0), (0.1, 0.3), name="left"), fold((0.3, 0.3), (0.3, 0.0), name="right")
    context = found_plan(garment(rectangle_points(0.4, 0.3), *flaps), max_expanded=1).context
    after = [State(done, (0.0, 0.0), 0, 0) for done in (0b01, 0b10)]
    for state, other in zip(after, (1, 0), strict=True):
        context.obstacles.note(Obstacle(other, Code.SLIPS, worded("slips", SLIPPING), 0.1, state))
    of_no_importance = worded("beside_table", {"off_m": 0.01})
    context.obstacles.note(Obstacle(1, Code.NOT_A_G_STATE, of_no_importance, 0.01, START))
    found = reasons(context, {situation(START), *map(situation, after)}, ())
    assert [(r.fold, r.code) for r in found] == [(0, Code.SLIPS), (1, Code.SLIPS)]


RIBBON = garment(
    rectangle_points(0.05, 0.3), fold((0.05, 0.15), (0.0, 0.15), radius_m=0.01), placement=Pose2(-0.7, 0.21, BACK)
)
"""A ribbon whose corners are too near for two hands."""

NAMED_ALIKE = {
    "arm",
    "back_off_m",
    "cause",
    "is_at_least",
    "joint",
    "needed_friction",
    "needed_grip_radius_m",
    "shift_m",
    "short_by_m",
    "station",
}
"""Fields of reasons that are values of some messages too."""


@pytest.mark.parametrize(
    ("cloth", "scene", "code"),
    [
        (strip(FURTHEST_X - COMFORT_M - 0.05, 0.3, 0.1), fixed(1.35), "out_of_reach"),
        (strip(FURTHEST_X - 0.016, 0.3, 0.1), fixed(), "out_of_reach"),
        (RIBBON, Scene(), "grips_too_close"),
        (hammer(), HAMMER_SCENE, "afterwards"),
    ],
)
def test_what_a_reason_and_its_message_both_say_is_the_same(cloth: Garment, scene: Scene, code: str) -> None:
    found = refused(cloth, scene).reasons
    assert code in {reason.says.code for reason in found}
    for reason in found:
        told = {**reason.says.values, **reason.says.values.get("what", {})}
        both = NAMED_ALIKE & told.keys()
        assert {name: getattr(reason, name) for name in both} == {name: told[name] for name in both}
        comfort_m = told.get("enough_comfort_m")
        assert comfort_m is None or comfort_m == reason.comfort_m


def test_every_reason_is_json_with_plain_numbers() -> None:
    for reason in shipped_plan("scarf-halved").to_dict()["reasons"]:
        assert isinstance(reason["code"], str) and isinstance(reason["message"], str)
        numbers = [reason[name] for name in ("short_by_m", "back_off_m", "shift_m") if reason[name] is not None]
        assert all(type(number) is float and np.isfinite(number) for number in numbers)
        assert all(reason[name] is None or len(reason[name]) == 3 for name in ("point", "towards", "shift_towards"))
        assert type(reason["is_at_least"]) is bool
        is_of_reach = reason["code"] == "out_of_reach"
        assert (reason["offset_m"] is not None) == (reason["approach"] is not None) == is_of_reach
        if is_of_reach:
            assert [type(length) for length in reason["offset_m"]] == [float, float]
            assert {name: type(angle) for name, angle in reason["approach"].items()} == {
                "heading_rad": float,
                "pitch_rad": float,
            }
