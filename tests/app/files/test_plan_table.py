import csv
import io
import math
from dataclasses import replace

import numpy as np
import pytest

from app.files.plan_table import plan_table
from planner import Scene, load_garment, make_plan
from planner.task.plan import Plan
from planner.task.scene import DEFAULT_STATIONS
from tests.replay.planned import shipped_plan

HEIGHT_M = 0.79


def rows_of(plan: Plan) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(plan_table(plan))))


def point(row: dict[str, str], arm: str, moment: str, frame: str) -> list[float]:
    return [float(row[f"{arm}_{moment}_in_{frame}_{axis}_m"]) for axis in "xyz"]


@pytest.fixture(scope="module")
def hand_towel() -> Plan:
    return shipped_plan("hand-towel")


@pytest.fixture(scope="module")
def big_towel() -> Plan:
    """Plan the big towel, which drags, drives while it folds, and folds while held."""
    return shipped_plan("big-towel")


def test_there_is_one_row_for_each_primitive_and_they_follow_one_another(big_towel: Plan) -> None:
    rows = rows_of(big_towel)
    assert [row["kind"] for row in rows] == [primitive.kind for primitive in big_towel.primitives]
    starts, ends = ([float(row[name]) for row in rows] for name in ("start_s", "end_s"))
    assert starts == pytest.approx([0.0, *ends[:-1]])
    assert ends[-1] == pytest.approx(big_towel.cost_s)
    for row in rows:
        assert float(row["driving_s"]) + float(row["arms_s"]) == pytest.approx(float(row["duration_s"]))


def test_a_fold_made_from_where_the_robot_starts_has_its_points_in_both_frames(hand_towel: Plan) -> None:
    # The towel lies from x = -0.75 m on, its near corners at y = +-0.343 m; the tools are 2 cm over the table. `front`
    # is at (-0.95, 0) looking along x, and the table is 0.79 m high. At the apex a tool stands over the line at
    # x = -0.75 + 0.2095 m by as much higher as the corner was from it, and comes down as far beyond.
    row = rows_of(hand_towel)[0]
    assert row["what"] == "half"
    assert float(row["driving_s"]) == 0.0
    assert [float(row[f"base_at_pick_{name}"]) for name in ("x_m", "y_m", "yaw_rad")] == [-0.95, 0.0, 0.0]
    assert point(row, "left", "pick", "table") == pytest.approx([-0.75, 0.343, 0.02])
    assert point(row, "left", "pick", "base") == pytest.approx([0.2, 0.343, 0.02 + HEIGHT_M])
    assert point(row, "left", "apex", "base") == pytest.approx([0.2 + 0.2095, 0.343, 0.02 + 0.2095 + HEIGHT_M])
    assert point(row, "right", "place", "base") == pytest.approx([0.2 + 0.419, -0.343, 0.02 + HEIGHT_M])


def test_each_point_is_seen_from_where_the_base_is_at_its_moment(big_towel: Plan) -> None:
    for row in rows_of(big_towel):
        for arm in ("left", "right"):
            for moment in ("pick", "apex", "place"):
                if row[f"{arm}_{moment}_in_table_x_m"]:
                    x, y, yaw = (float(row[f"base_at_{moment}_{name}"]) for name in ("x_m", "y_m", "yaw_rad"))
                    ahead, left, up = point(row, arm, moment, "base")
                    seen = [
                        x + ahead * math.cos(yaw) - left * math.sin(yaw),
                        y + ahead * math.sin(yaw) + left * math.cos(yaw),
                        up - HEIGHT_M,
                    ]
                    assert seen == pytest.approx(point(row, arm, moment, "table"))


def test_during_a_drag_the_hands_stay_where_they_are_as_the_base_sees_them(big_towel: Plan) -> None:
    drag = rows_of(big_towel)[0]
    assert drag["kind"] == "drag"
    assert point(drag, "left", "pick", "base") == pytest.approx(point(drag, "left", "place", "base"))
    assert drag["left_apex_in_table_x_m"] == ""
    moved = np.subtract(point(drag, "left", "place", "table"), point(drag, "left", "pick", "table"))
    assert moved == pytest.approx([-float(drag["distance_m"]), 0.0, 0.0])


def test_the_base_of_a_move_is_where_it_leaves_it_and_there_are_no_hands() -> None:
    plan = shipped_plan("jeans")
    move = next(row for row in rows_of(plan) if row["kind"] == "move")
    end = DEFAULT_STATIONS[move["station"]]
    assert [float(move[f"base_{name}"]) for name in ("x_m", "y_m")] == pytest.approx([end.x_m, end.y_m])
    assert move["left_pick_in_table_x_m"] == move["base_at_pick_x_m"] == ""


def test_heights_in_the_base_frame_are_above_the_floor_whatever_the_table() -> None:
    scene = Scene(table=replace(Scene().table, height_m=0.74))
    plan = make_plan(load_garment("hand-towel"), scene)
    assert plan.is_solved
    assert point(rows_of(plan)[0], "left", "pick", "base")[2] == pytest.approx(0.76)


def test_a_fold_whose_name_looks_like_a_formula_is_no_formula(hand_towel: Plan) -> None:
    cloth = hand_towel.garment
    named = replace(cloth, folds=(replace(cloth.folds[0], name='=HYPERLINK("there")'), *cloth.folds[1:]))
    plan = replace(hand_towel, task=replace(hand_towel.task, garment=named))
    assert rows_of(plan)[0]["what"] == '\'=HYPERLINK("there")'


@pytest.mark.parametrize("name", ["t-shirt", "jeans", "vest"])
def test_no_number_ends_in_the_noise_of_the_computation(name: str) -> None:
    plan = shipped_plan(name)
    for row, primitive in zip(rows_of(plan), plan.primitives, strict=True):
        numbers = {name: text for name, text in row.items() if name.endswith(("_m", "_s", "_rad")) and text}
        assert all(len(text.partition(".")[2]) <= 9 and "e" not in text and text != "-0.0" for text in numbers.values())
        for grip in primitive.grips:
            assert point(row, grip.arm, "pick", "table") == pytest.approx(grip.pick, abs=1e-9)
