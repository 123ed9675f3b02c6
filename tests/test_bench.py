"""The benchmark: its tables, its JSON, and its figures from the paper. No time is ever judged."""

import json
import math
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from app.drawing.garment_drawing import drawing_of
from app.rehearsal.judge import StepVerdict
from app.rehearsal.result import RehearsalResult, Run
from bench.__main__ import BENCHMARKS, main
from bench.any_robot import any_robot
from bench.chart import Panel, Point, Series, draw
from bench.crowd import crowd
from bench.frames import frames_of
from bench.growth import cases, growth
from bench.growth_cases import crowded, ribbon, tabs, tabs_on_two_sides
from bench.heuristics import heuristics
from bench.load import load
from bench.measurement import Case, Ratio, measure
from bench.paper import TABLE_1, TABLE_2, PaperRow
from bench.paper_tables import table_1, table_2
from bench.pin_arm import TORSO_M, pin_arm
from bench.re_plan import moved, re_plan, replanned
from bench.reach import Effort, reach_of
from bench.reach_queries import FURTHEST_M, any_poses, pinches
from bench.reach_truth import DenseReach, distance_m
from bench.rehearsal import GARMENTS as REHEARSED
from bench.rehearsal import HELD_OUT, HELD_OUT_IN, Rehearsed, held_out, row_of
from bench.report import Report, Row
from bench.robot_plans import LONGEST_M, robot_plans, shrunk
from bench.round_a_box import BOX_M, motions_of, round_a_box
from bench.served import served
from bench.studies import Run as StudyRun
from bench.studies import study_row
from bench.two_at_once import two_at_once
from bench.whole_plans import whole_plans
from bench.yes_and_no import yes_and_no
from planner import fold_dag, load_garment, make_plan, shipped_garment_names
from planner.folds.fold_sequence import replayed
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Pose2
from planner.planning.robot_task import default_scene
from planner.robots.load_robot import load_robot
from planner.robots.pr2.arm import read_arm
from planner.robots.pr2.description import read_model
from planner.robots.pr2.reach import APPROACHES

MEASURED = {
    "garment",
    "comfort_radius_m",
    "heuristic",
    "status",
    "folds",
    "primitives",
    "cost_s",
    "expanded",
    "explored",
    "ik_queries",
    "ik_time_s",
    "told_time_s",
    "search_time_s",
    "plan_time_s",
}

SHAPE = read_arm(read_model())
SHOULDER = np.array([SHAPE.shoulder_x, SHAPE.shoulder_y, SHAPE.shoulder_z + TORSO_M])


def written(report: Report, folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(report.write(folder).read_text(encoding="utf-8"))
    return content


def printed(report: Report) -> str:
    console = Console(width=200)
    with console.capture() as capture:
        console.print(report.to_table())
    return capture.get()


def test_the_papers_figures_are_those_of_its_tables() -> None:
    assert (TABLE_1["t-shirt"].primitives, TABLE_1["t-shirt"].cost_s) == (7, 48.12)
    assert (TABLE_1["skirt"].expanded, TABLE_1["skirt"].explored, TABLE_1["skirt"].ik_queries) == (60, 535, 10087)
    assert (TABLE_1["hand-towel"].search_time_s, TABLE_1["hand-towel"].ik_time_s) == (5.04, 1.90)
    assert (TABLE_2["shirt"].search_time_s, TABLE_2["shirt"].ik_time_s) == (121.70, 85.99)
    assert (TABLE_2["jeans"].explored, TABLE_2["jeans"].ik_queries) == (60, 272)
    assert (TABLE_2["hand-towel"].expanded, TABLE_2["hand-towel"].overhead_s) == (17, 0.004)


def test_both_tables_of_the_paper_have_the_same_plans_of_the_nine_garments() -> None:
    # In the paper the comfort radius changes the search only, not one plan.
    plans_1, plans_2 = (
        {name: (row.folds, row.primitives, row.cost_s) for name, row in table.items()} for table in (TABLE_1, TABLE_2)
    )
    assert len(plans_1) == 9
    assert plans_1 == plans_2


@pytest.mark.parametrize(("build", "comfort_m", "paper"), [(table_1, 0.0, TABLE_1), (table_2, 0.03, TABLE_2)])
def test_a_table_has_our_row_above_the_papers(
    build: Callable[[Sequence[str], int], Report], comfort_m: float, paper: Mapping[str, PaperRow], tmp_path: Path
) -> None:
    report = build(["hand-towel"], 1)
    assert [[line[1] for line in row.lines] for row in report.rows] == [["Pleat", "paper"]]
    assert all(len(line) == len(report.columns) for row in report.rows for line in row.lines)
    assert report.to_table().row_count == 2
    assert "search [s]" in printed(report)

    (row,) = written(report, tmp_path)["rows"]
    assert row["garment"] == "hand-towel"
    assert set(row["pleat"]) == MEASURED
    assert row["pleat"]["comfort_radius_m"] == comfort_m
    assert row["pleat"]["status"] == "solved"
    assert row["pleat"]["folds"] == row["paper"]["folds"] == 3
    assert row["paper"]["search_time_s"] == paper["hand-towel"].search_time_s


def test_a_report_says_what_it_was_run_on(tmp_path: Path) -> None:
    content = written(Report("empty", "Nothing", ("a",), (), 1), tmp_path)
    assert (tmp_path / "empty.json").exists()
    assert set(content) == {"name", "title", "repetitions", "source", "environment", "rows"}
    assert set(content["environment"]) == {"cores", "load", "architecture", "system", "python", "libraries"}
    assert content["environment"]["cores"] >= 1
    assert {"numba", "pin", "shapely"} <= set(content["environment"]["libraries"])


def test_the_heuristic_saves_expansions_at_the_same_cost(tmp_path: Path) -> None:
    (row,) = written(heuristics(["hand-towel"], 1), tmp_path)["rows"]
    assert row["arm_time"]["cost_s"] == pytest.approx(row["zero"]["cost_s"])
    assert row["expanded_ratio"] >= 1
    assert set(row["search_time_ratio"]) == {"median", "least", "most"}


def test_repetitions_come_out_the_same() -> None:
    first, second = measure(Case("hand-towel", 0.0), Case("hand-towel", 0.0), repetitions=2)
    assert first.outcome == second.outcome
    assert len(first.search_times_s) == 2
    assert all(0 < told <= whole for told, whole in zip(first.told_times_s, first.plan_times_s, strict=True))


def test_a_ratio_is_the_median_of_the_turns() -> None:
    # 2/1, 9/3, 4/4
    assert Ratio.of([2, 9, 4], [1, 3, 4]) == Ratio(median=2, least=1, most=3)


def test_a_garment_without_a_peer_is_left_out() -> None:
    assert yes_and_no(["hand-towel"], 1).rows == ()


@pytest.mark.long
def test_only_what_is_asked_for_is_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["--quick", "--only", "table-1", "first-plan", "hand-towel"], tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"table-1.json", "first-plan.json"}
    (row,) = json.loads((tmp_path / "first-plan.json").read_text(encoding="utf-8"))["rows"]
    times = {"import_s", "first_plan_s", "first_plan_cpu_s", "second_plan_s"}
    assert set(row) == {"garment", "plan_time_ratio", *times}
    assert "hand-towel" in capsys.readouterr().out


def test_whole_plans_cost_the_same_whatever_is_known_and_are_added_up() -> None:
    *rows, total = (row.data for row in whole_plans(["hand-towel", "vest"], 1).rows)
    assert [(row["garment"], round(row["cost_s"], 3)) for row in rows] == [("vest", 18.8), ("hand-towel", 27.0)]
    for name in ("anew_cpu_ms", "paths_known_cpu_ms", "all_known_cpu_ms"):
        assert total[name] == sum(row[name] for row in rows) > 0.0
    assert total["anew_cpu_ms"] > total["all_known_cpu_ms"], "what is known saves work"


def test_a_name_that_is_no_table_and_no_garment_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_:
        main(["--only", "socks"])
    assert exit_.value.code == 2
    message = capsys.readouterr().err
    assert all(name in message for name in ("socks", *BENCHMARKS))


def test_the_arm_of_the_benchmark_is_where_its_lengths_say() -> None:
    # Upper arm ahead, forearm up, hand back: 0.1 + 0.4 - 0.18 ahead of the shoulder, 0.321 above it.
    quarter = math.pi / 2
    tool = pin_arm().tool(np.array([0.0, 0.0, 0.0, -quarter, 0.0, -quarter, 0.0]))
    np.testing.assert_allclose(tool.translation, SHOULDER + np.array([0.32, 0.0, 0.321]), atol=1e-9)
    np.testing.assert_allclose(tool.rotation @ (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), atol=1e-9)


STRETCHED_M = 0.5 * math.cos(math.asin(0.321 / 0.5 * math.sin(0.1))) + 0.321 * math.cos(0.1) + 0.18
"""How far ahead of the shoulder a tool that points ahead can be (m)."""


def test_the_truth_about_reach_ends_where_the_arm_does() -> None:
    # Soft limits keep the wrist bent by .1 rad at least, so the forearm turns aside by as much. Upper arm and shoulder,
    # .5 m, turn back by asin(.321 / .5 sin .1) = .0641 rad, which bends the elbow by .1641, more than its .15 at least.
    lengths = STRETCHED_M + np.array([-1e-4, 1e-4, 2.0])
    points = SHOULDER + lengths[:, None] * np.array([1.0, 0.0, 0.0])
    rotations = np.broadcast_to(np.eye(3), (3, 3, 3))
    np.testing.assert_array_equal(DenseReach().can_reach(points, rotations), [True, False, False])


def test_a_pose_is_no_further_from_the_boundary_than_the_way_straight_out() -> None:
    # 21 mm short of stretched ahead, within soft limits; what is tried grows by 2 mm there.
    point = SHOULDER + np.array([STRETCHED_M - 0.021, 0.0, 0.0])
    assert 0.0 < distance_m(DenseReach(), point, np.eye(3)) <= 0.0235


def test_queries_are_the_same_every_time_and_lie_round_the_boundary() -> None:
    poses, again = any_poses(300), any_poses(300)
    np.testing.assert_array_equal(poses.points, again.points)
    answers = DenseReach().can_reach(poses.points, poses.rotations)
    assert answers[poses.is_sure].all()
    assert 0.3 < answers.mean() < 0.9
    pinched = pinches(poses)
    expected = np.array([APPROACHES[number].rotation for number in pinched.approaches])
    np.testing.assert_array_equal(pinched.rotations, expected)
    assert np.abs(pinched.points - poses.points).max() < 1e-5 < FURTHEST_M


def test_reach_is_asked_of_all_methods_and_judged_by_forward_kinematics(tmp_path: Path) -> None:
    report = reach_of(Effort(1, 150, 2))
    assert "batches of 100" in printed(report)
    rows = {row["method"]: row for row in written(report, tmp_path)["rows"]}
    for name, row in rows.items():
        if row["is_installed"]:
            assert row["false_positives"] == row["beyond_truth"] == 0, name
            assert 0.0 <= row["recall"] <= 1.0 and row["cpu_us"] > 0.0
    ours = [row for name, row in rows.items() if "Pleat" in name or "memory" in name or "pinches" in name]
    assert len(ours) == 7
    assert all(row["queries"] == 150 and row["recall"] >= 0.9995 for row in ours)
    assert rows["least squares, 20 starts"]["queries"] == 2


def test_a_peer_that_is_not_installed_is_said_to_be_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("trac_ik", "eaik", "eaik.pybindings.EAIK"):
        monkeypatch.setitem(sys.modules, module, None)
    report = reach_of(Effort(1, 20, 1))
    missing = [row.lines[0][0] for row in report.rows if row.lines[0][1] == "not installed"]
    assert missing == ["pytracik, 1 ms", "pytracik, 5 ms", "eaik, 16 pans"]


def test_a_ribbon_is_a_chain_and_tabs_wait_for_nothing() -> None:
    assert fold_dag(ribbon(5)).dag.edges == ((0, 1), (1, 2), (2, 3), (3, 4))
    assert fold_dag(tabs(5)).dag.edges == ()
    assert len(tabs_on_two_sides(5).folds) == 5
    assert fold_dag(tabs_on_two_sides(6)).dag.edges == ()


@pytest.mark.parametrize("count", [5, 6, 50])
def test_more_stations_stand_beside_the_table_and_face_it(count: int) -> None:
    scene = crowded(count)
    assert len({name for name, _ in scene.stations}) == count
    for _, pose in scene.stations[5:]:
        ahead = (pose.x_m + 0.2 * math.cos(pose.yaw_rad), pose.y_m + 0.2 * math.sin(pose.yaw_rad))
        assert abs(pose.x_m) == pytest.approx(0.95) or abs(pose.y_m) == pytest.approx(0.64)
        assert abs(ahead[0]) <= 0.8 and abs(ahead[1]) <= 0.49


@pytest.mark.long
def test_growth_is_measured_and_drawn(tmp_path: Path) -> None:
    report = growth([], 1)
    rows = {(row["grows"], row["series"]): row for row in written(report, tmp_path)["rows"]}
    # Nothing but two folds to be done, one after the other: a search expands two states, and there are two of
    # them, since hands come late to the first path.
    chained = rows["folds", "ribbon rolled up"]
    assert (chained["status"], chained["expanded"]) == ("solved", 4)
    assert chained["cost_s"] == pytest.approx(22.09, abs=0.01)
    assert {grows for grows, _ in rows} == {"folds", "stations", "comfort radius [cm]"}
    words = [element.text for element in ET.fromstring(report.figure).iter() if element.tag.endswith("text")]
    assert {"search time [s]", "states expanded", "comfort radius [cm]", "ribbon rolled up"} <= set(words)


def test_growth_is_asked_of_2_to_40_folds_5_to_50_stations_and_1_to_5_cm() -> None:
    sizes: dict[str, set[int]] = {}
    for case in cases(is_quick=False):
        sizes.setdefault(case.panel, set()).add(case.size)
        assert case.panel != "comfort radius [cm]" or case.comfort_radius_m == pytest.approx(0.01 * case.size)
        assert case.panel != "stations" or len(case.scene.stations) == case.size
    assert {2, 40} <= sizes["folds"] and {5, 50} <= sizes["stations"]
    assert sizes["comfort radius [cm]"] == {1, 2, 3, 4, 5}


def test_a_charts_axes_are_logarithmic_and_what_ran_out_of_time_is_hollow() -> None:
    line = Series("a line", (Point(1.0, 10.0), Point(10.0, 100.0), Point(100.0, 1000.0, is_full=False)))
    elements = list(ET.fromstring(draw([[Panel("x [m]", "y [s]", (line,))]])).iter())
    marks = [e for e in elements if "point" in e.get("class", "").split()]
    (x0, y0), (x1, y1), (x2, y2) = ((float(e.get("cx", "")), float(e.get("cy", ""))) for e in marks)
    assert x1 - x0 == pytest.approx(x2 - x1, abs=0.2) and y0 - y1 == pytest.approx(y1 - y2, abs=0.2)
    assert x0 < x1 and y0 > y1
    assert ["hollow" in e.get("class", "") for e in marks] == [False, False, True]


def test_a_moved_corner_is_a_centimetre_away_and_no_other_moves() -> None:
    drawing = drawing_of(load_garment("t-shirt"))
    changed = moved(drawing, 2, 0.5)
    gaps = [math.dist(a, b) for a, b in zip(drawing.points, changed.points, strict=True)]
    assert gaps[2] == pytest.approx(0.01)
    assert max(gap for i, gap in enumerate(gaps) if i != 2) == 0.0


@pytest.mark.long
def test_re_planning_is_timed_for_each_move(tmp_path: Path) -> None:
    (row,) = written(re_plan(["hand-towel"], 1), tmp_path)["rows"]
    assert sum(row["statuses"].values()) == 1
    for spent in (row["first_cpu_ms"], row["final_cpu_ms"]):
        assert 0.0 < spent["median"] <= spent["p95"] <= spent["most"]
    moves = replanned("vest", 3)
    assert len(moves) == 3
    assert all(0.0 < move.first_cpu_s <= move.final_cpu_s for move in moves)
    assert any(move.is_soon for move in moves), "most centimetres ask for no other plan"


@pytest.mark.long
def test_frames_are_shown_to_viewers_who_read_them(tmp_path: Path) -> None:
    (row,) = written(frames_of(["hand-towel"], 90, viewers=(0, 2)), tmp_path)["rows"]
    unwatched, watched = row["runs"]
    # 27 s at 30 frames a second, of 90 frames one, and the first.
    assert unwatched["frames"] == watched["frames"] == 10
    assert unwatched["read"] == [] and len(watched["read"]) == 2
    assert all(viewer["messages"] >= 5 and viewer["bytes"] > 1000 for viewer in watched["read"])
    for run in row["runs"]:
        assert 0.0 < run["show_ms"]["median"] <= run["server_ms"]["median"]


def test_naming_a_garment_leaves_out_what_is_of_no_garment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    asked: dict[str, Sequence[str]] = {}

    def noted(name: str, garments: Sequence[str], repetitions: int) -> Report:
        asked[name] = garments
        return Report(name, name, ("garment",), (Row((("vest",),), {}),), repetitions)

    monkeypatch.setattr("bench.__main__.BENCHMARKS", {name: partial(noted, name) for name in BENCHMARKS})
    main(["--quick", "--only", "vest"], tmp_path, tmp_path)
    assert {path.stem for path in tmp_path.iterdir()} == set(asked)
    assert {"table-1", "re-plan", "first-plan"} <= set(asked)
    assert not set(asked) & {"reach", "any-robot", "round-a-box", "growth", "rehearsal"}
    assert all(garments == ["vest"] for garments in asked.values())


@pytest.mark.long
def test_every_garment_that_is_rehearsed_can_be_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    asked: list[Sequence[str]] = []

    def noted(garments: Sequence[str], repetitions: int) -> Report:
        asked.append(garments)
        return Report("rehearsal", "rehearsal", (), (), repetitions)

    monkeypatch.setattr("bench.__main__.BENCHMARKS", {"rehearsal": noted})
    main(["--quick", "--only", "rehearsal"], tmp_path, tmp_path)
    for garment in REHEARSED:
        main(["--quick", "--only", "rehearsal", garment], tmp_path, tmp_path)
    everything, *each = asked
    assert set(REHEARSED) <= set(everything)
    assert each == [[garment] for garment in REHEARSED]


def test_garments_that_no_setting_was_chosen_by_are_not_shipped_and_can_be_folded() -> None:
    assert not set(HELD_OUT) & set(shipped_garment_names())
    assert sorted(path.stem for path in HELD_OUT_IN.glob("*.json")) == sorted(HELD_OUT)
    for name in HELD_OUT:
        garment = load_garment(HELD_OUT_IN / f"{name}.json")
        assert garment.name == name
        replayed(garment)  # raises where a fold is not possible


def test_runs_of_the_garments_that_no_setting_was_chosen_by_are_counted_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def made(garment: str) -> Rehearsed:
        return Rehearsed(garment, "real", True, RehearsalResult((Run(0, ()), Run(1, (), reason="stopped"))))

    monkeypatch.setattr("bench.rehearsal.rehearsed_held_out", made)
    monkeypatch.setattr("bench.rehearsal.ProcessPoolExecutor", lambda *_, **__: nullcontext(SimpleNamespace(map=map)))
    rows = held_out([], 1).rows
    assert [row.data["garment"] for row in rows] == [*HELD_OUT, "all"]
    assert (rows[-1].data["held"], rows[-1].data["of"]) == (6, 12)


def test_a_rehearsal_tells_its_steps_the_first_lost_and_how_often_it_held() -> None:
    held, lost = (
        StepVerdict(0, 0.98, 1.0, 3.0, 8.0, 1.0, 0.0),
        StepVerdict(1, 0.8, 14.0, 21.0, 60.0, 9.0, 0.1, held=False),
    )
    result = RehearsalResult((Run(0, (held, lost), simulated_s=10.0, cpu_s=20.0), Run(1, (held,), reason="stopped")))
    (line,) = row_of(Rehearsed("vest", "real", True, result)).lines
    assert line == ("vest", "real", "on", "2 of 3", "1", "0.890", "12.0", "0 of 2", "0% to 84%", "0.50", "20.00")


def test_motions_round_a_box_begin_on_its_left_and_end_on_its_right_and_touch_nothing() -> None:
    motions = motions_of("pr2", 1)
    robot, torso_m = load_robot("pr2"), default_scene("pr2").torso_m
    for side, ends in ((1.0, motions.pairs[:, 0]), (-1.0, motions.pairs[:, 1])):
        assert motions.are_all_free(ends)
        for x, y, _ in robot.tool_places(0, ends[:, motions.span], torso_m).tolist():
            _, across_m = Isometry.rotation(motions.base.yaw_rad, motions.base.x_m, motions.base.y_m).apply_point(
                (x, y)
            )
            assert side * across_m > 0.5 * BOX_M[1]


def test_paths_round_a_box_are_counted_where_they_are_free(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("bench.round_a_box.ROBOTS", ("pr2",))
    monkeypatch.setattr("bench.round_a_box.FEW_MOTIONS", 3)
    monkeypatch.setattr("bench.round_a_box.find_spec", lambda _: None)
    (row,) = written(round_a_box([], 1), tmp_path)["rows"]
    (ours,) = row["planners"]
    assert ours["planner"] == "Pleat" and len(ours["times_ms"]) == 3
    assert len(ours["ways_rad"]) == ours["found"] >= 1
    monkeypatch.setattr("bench.round_a_box._is_free", lambda *_: False)
    (row,) = written(round_a_box([], 1), tmp_path)["rows"]
    assert row["planners"][0]["found"] == 0 and row["time_ratios"] == {}


@pytest.mark.long
def test_every_shipped_robot_has_a_row_of_reach(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    thin = {"POSES": 300, "RESTARTS": 3, "shipped_robots": lambda: ("so101-pair",), "heights": lambda *_: (0.0, 0.03)}
    for name, less in thin.items():
        monkeypatch.setattr(f"bench.any_robot.{name}", less)
    (row,) = written(any_robot([], 1), tmp_path)["rows"]
    assert row["robot"] == "so101-pair"
    assert row["reachable"] > row["missed"] >= 0
    assert row["map_mb"] > 0.0
    assert 0.9 < row["random_recall"] <= 1.0


@pytest.mark.long
def test_every_other_robot_has_a_row_for_each_garment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("bench.robot_plans.shipped_robots", lambda: ("pr2", "so101-pair"))
    monkeypatch.setattr("bench.robot_plans.EDITS", 1)
    report = robot_plans(["scarf", "scarf-halved"], 1)
    (row,) = written(report, tmp_path)["rows"]
    assert (row["robot"], row["garment"], row["status"]) == ("so101-pair", "scarf", "solved")
    assert row["cost_s"] > 0.0
    assert row["cpu_s"] > 0.0
    assert len(row["edits_ms"]) == 1 and row["edits_ms"][0] > 0.0
    assert robot_plans(["scarf-halved"], 1).rows == ()


@pytest.mark.long
def test_a_garment_that_a_robot_cannot_fold_where_it_lies_is_laid_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bench.robot_plans.shipped_robots", lambda: ("so101-pair",))
    monkeypatch.setattr("bench.robot_plans.EDITS", 0)
    (row,) = (row.data for row in robot_plans(["jeans"], 1).rows)
    assert (row["status"], row["cost_s"]) == ("infeasible", None)
    assert row["why_not"] and row["place_cost_s"] > 0.0
    garment = shrunk(load_garment("jeans"), 0.35)
    there = Pose2(**row["place"])
    assert make_plan(garment, robot="so101-pair", placement=there).cost_s == pytest.approx(row["place_cost_s"])


def test_garments_for_small_tables_are_shrunk_with_their_folds_and_small_ones_are_not() -> None:
    jeans, towel = load_garment("jeans"), load_garment("hand-towel")
    small = shrunk(jeans, 0.5)
    share = np.ptp(small.outline, axis=0).max() / np.ptp(jeans.outline, axis=0).max()
    assert np.ptp(small.outline, axis=0).max() == pytest.approx(0.5)
    assert share < 1.0
    np.testing.assert_allclose(small.folds[0].start, np.multiply(jeans.folds[0].start, share))
    assert shrunk(towel, LONGEST_M).outline == towel.outline


@pytest.mark.long
def test_a_crowd_edits_and_asks_for_plans(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name, less in (("OPEN", 2), ("DRAGGED", 1), ("QUICK_S", 1.0)):
        monkeypatch.setattr(f"bench.crowd.{name}", less)
    monkeypatch.setattr("bench.load_clients.PLAN_LIMIT_S", 1.0)
    with served() as server:
        monkeypatch.setattr("bench.crowd.served", lambda: nullcontext(server))  # one for both: it starts for seconds
        report = crowd(["hand-towel"], 1)
    assert "5 plans a second" in printed(report)
    alone, beside_plans = written(report, tmp_path)["rows"]
    assert alone["plans"] == 0 < beside_plans["plans"]
    for row in (alone, beside_plans):
        assert 0 < row["edits"] <= row["edits_wanted"] + 1
        assert 0.0 < row["edit_ms"]["median"] <= row["edit_ms"]["p99"] <= row["edit_ms"]["most"]
    assert crowd(["scarf-halved"], 1).rows == ()


@pytest.mark.long
def test_two_plans_at_once_are_set_beside_two_in_turn() -> None:
    (row,) = two_at_once(["hand-towel", "vest"], 1).rows
    assert row.data["plans"] == ["vest", "hand-towel"] or row.data["plans"] == ["hand-towel", "vest"]
    assert row.data["in_turn_cpu_s"] > 0.0 and row.data["at_once_cpu_s"] > 0.0
    assert two_at_once(["hand-towel"], 1).rows == ()


@pytest.mark.long
def test_a_load_tells_what_was_refused_what_grew_and_what_stayed_open(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name, less in (("OPEN", 3), ("VIEWERS", 4), ("DRAGGED", 1), ("CLOSED_WITHIN_S", 0.0)):
        monkeypatch.setattr(f"bench.load.{name}", less)
    report = load(["hand-towel"], 1, 0.02)
    assert "left open" in printed(report)
    (row,) = written(report, tmp_path)["rows"]
    assert 0 < row["edits"] <= row["edits_wanted"] + 1
    assert row["edits_by_status"] == {"200": row["edits"]}
    assert 0.0 < row["edit_ms"]["median"] <= row["edit_ms"]["p99"] <= row["edit_ms"]["most"]
    assert 0 < row["plans"] == sum(row["plans_by_status"].values())
    assert row["messages"] >= 4 and row["memory_first_mb"] > 0.0
    # All have left, and nobody has waited until the server closes what is not used any more.
    assert row["left_open"]["sockets"] == 0 < row["left_open"]["documents"] <= 3
    assert load(["scarf-halved"], 1).rows == ()


def test_a_study_is_told_with_what_it_takes_beyond_the_plain_loop() -> None:
    runs = [StudyRun(4.0, 3.0, (100.0, 120.0)), StudyRun(2.0, 2.0), StudyRun(3.0, 2.5)]
    row = study_row("processes, 2", 10, runs, 2.0)
    # The medians are 3 s by the clock and 2.5 s of CPU: 50 ms a cell beyond the loop's 200.
    assert row.lines == (("processes, 2", "10", "3.3", "250.0", "50.0", "100", "120"),)
    assert row.data["beyond_loop_ms"] == pytest.approx(50.0)
