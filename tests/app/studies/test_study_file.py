import json
import re
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from app.job_kinds.studies import STUDIES
from app.jobs.job_kind import Stores
from app.studies.fields import StudyError
from app.studies.garment_entries import Sources
from app.studies.study import Study
from app.studies.study_file import FIELDS, read_study, study_of
from planner import load_garment
from planner.geometry.pose import Pose2
from planner.planning.robot_task import default_scene, task_for
from tests.app.samples import towel
from tests.app.studies.study_samples import content, study


def test_the_product_is_counted_without_making_a_cell() -> None:
    found = study(
        garments=[{"name": "vest"}, {"name": "tie"}],
        table={"height_m": {"from": 0.6, "to": 0.9, "step": 0.1}},
        limits={"comfort_radius_m": [0.0, 0.03]},
    )
    assert found.count == found.product == 2 * 4 * 2
    assert found.axes[1].values == (0.6, 0.7, 0.8, 0.9)


def test_every_cell_is_the_task_of_its_values() -> None:
    found = study(
        garments=[{"name": "vest"}, {"name": "tie"}],
        table={"height_m": [0.7, 0.8]},
        scene={"friction": [0.5, 1.0], "torso_m": 0.2},
        limits={"comfort_radius_m": [0.0, 0.03], "heuristic": ["zero", "arm_time"]},
    )
    cells = list(found.cells(found.indices()))
    assert [cell.index for cell in cells] == list(range(2 * 2 * 2 * 2 * 2))
    assert len({json.dumps(cell.task.to_dict()) for cell in cells if cell.task}) == len(cells)
    last = cells[-1].task
    assert last is not None
    assert last.garment == load_garment("tie")
    assert (last.scene.table.height_m, last.scene.friction, last.scene.torso_m) == (0.8, 1.0, 0.2)
    assert (last.limits.comfort_radius_m, last.limits.heuristic) == (0.03, "arm_time")


def test_each_robot_has_the_scene_and_the_place_that_suit_it() -> None:
    found = study(garments=[{"name": "tie"}], robots=["pr2", "so101-pair"], table={})
    first, second = (cell.task for cell in found.cells(found.indices()))
    assert first is not None and second is not None
    assert first.scene == default_scene("pr2") and second.scene == default_scene("so101-pair")
    for task in (first, second):
        assert task.start == task_for(load_garment("tie"), robot=task.robot).start


def test_fields_of_the_robots_cards_are_axes() -> None:
    found = study(robots=["so101-pair"], table={}, card={"mounts": {"0": {"y_m": [0.15, 0.2]}}, "scene.torso_m": 0.0})
    cells = list(found.cells(found.indices()))
    assert [cell.values["card.mounts.0.y_m"] for cell in cells] == [0.15, 0.2]
    assert [cell.task.robot for cell in cells if cell.task] == [
        "so101-pair@mounts.0.y_m=0.15:scene.torso_m=0.0",
        "so101-pair@mounts.0.y_m=0.2:scene.torso_m=0.0",
    ]
    lower = study(table={}, card={"scene.table.height_m": [0.7]})
    (cell,) = lower.cells(lower.indices())
    assert cell.task is not None and cell.task.scene.table.height_m == 0.7


def test_work_ends_a_cell_by_default_so_that_every_machine_gives_the_same_table() -> None:
    cell = study(limits={}).cell(0)
    assert cell.task is not None
    assert cell.task.limits.work_limit_s == 10.0
    assert cell.task.limits.time_limit_s == 60.0


def test_a_sample_is_drawn_with_its_seed_and_without_repetition() -> None:
    many = {"table": {"height_m": {"from": 0.5, "to": 1.0, "count": 51}}}
    drawn = [study(**many, sample={"cells": 10, "seed": seed}).indices() for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    assert len(set(drawn[0])) == 10
    assert list(drawn[0]) == sorted(drawn[0])


def test_a_sample_of_a_product_that_could_never_be_listed_is_drawn() -> None:
    axis = {"from": 0.0, "to": 1.0, "count": 1000}
    found = study(scene={"friction": axis, "torso_m": {"from": 0.0, "to": 0.3, "count": 1000}}, sample={"cells": 3})
    assert (found.product, found.count, len(list(found.cells(found.indices())))) == (4_000_000, 3, 3)


def test_a_template_gives_a_garment_for_each_combination_of_its_measures() -> None:
    measures = {"width_m": [0.4, 0.5], "length_m": {"from": 0.2, "to": 0.4, "count": 3}}
    cases = study(garments=[{"template": "towel", "measures": measures}]).garments
    assert len({case.label for case in cases}) == 6
    assert [case.measures["width_m"] for case in cases] == [0.4] * 3 + [0.5] * 3


def test_measures_that_do_not_fit_each_other_are_cells_without_a_task() -> None:
    measures = {"width_m": 0.4, "folded_width_m": [0.1, 0.3]}
    cells = [*study(garments=[{"template": "towel", "measures": measures}], table={}).cells(range(2))]
    assert cells[0].task is None
    assert "folded_width_m" in str(cells[0].error)
    assert cells[1].task is not None


def test_random_garments_come_from_their_seed_alone() -> None:
    entry = {"random": 5, "seed": 3, "folds": [2, 3]}
    first, second = (study(garments=[entry]).garments for _ in range(2))
    assert first == second
    assert len({case.garment.outline for case in first if case.garment}) == 5
    assert all(case.garment and 1 <= len(case.garment.folds) <= 3 for case in first)
    assert study(garments=[{**entry, "random": 1, "seed": 4}]).garments[0].garment == first[1].garment


def test_files_are_found_beside_the_study(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / f"{name}.json").write_text(json.dumps(towel(name)))
    labels = [
        case.label for case in study_of(content(garments=[{"file": "*.json"}]), Sources(folder=tmp_path)).garments
    ]
    assert labels == ["one", "two"]


def test_files_that_are_not_there_are_told_with_their_field(tmp_path: Path) -> None:
    for pattern in ("no.json", "no-*.json"):
        with pytest.raises(StudyError, match=r"garments\[0\]\.file"):
            study_of(content(garments=[{"file": pattern}]), Sources(folder=tmp_path))


def test_a_garment_can_be_drawn_in_the_study_itself() -> None:
    cell = study(garments=[{"garment": towel()}]).cell(0)
    assert cell.task is not None
    assert cell.task.garment.name == "my-towel"


def test_stations_and_the_own_placement_keep_their_distance_to_the_edges() -> None:
    here, there = (study(table={"width_m": w, "depth_m": d}).cell(0).task for w, d in ((0.98, 1.6), (1.18, 1.4)))
    assert here is not None
    assert there is not None
    assert dict(there.scene.stations)["left"].y_m == pytest.approx(dict(here.scene.stations)["left"].y_m + 0.1)
    assert dict(there.scene.stations)["front"].x_m == pytest.approx(dict(here.scene.stations)["front"].x_m + 0.1)
    assert there.start.placement.x_m == pytest.approx(here.start.placement.x_m + 0.1)


def test_given_stations_stay_where_they_are_given() -> None:
    stations = {"front": {"x_m": -1.0, "y_m": 0.0, "yaw_rad": 0.0}}
    task = study(scene={"stations": stations}, table={"depth_m": 1.0}).cell(0).task
    assert task is not None
    assert task.scene.stations == (("front", Pose2(-1.0, 0.0, 0.0)),)


@pytest.mark.parametrize(
    ("placements", "expected"),
    [
        ("own", Pose2(-0.75, 0.15, -1.5707963267948966)),
        ({"moved": {"x_m": [0.1]}}, Pose2(-0.65, 0.15, -1.5707963267948966)),
        ([{"x_m": 0.1, "y_m": 0.2, "yaw_rad": 0.3}], Pose2(0.1, 0.2, 0.3)),
        ({"middle": {"x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0}}, Pose2(-0.15, -0.1, 0.0)),
    ],
)
def test_a_garment_lies_where_the_placements_say(placements: Any, expected: Pose2) -> None:
    task = study(placements=placements).cell(0).task
    assert task is not None
    found = task.start.placement
    assert (found.x_m, found.y_m, found.yaw_rad) == pytest.approx((expected.x_m, expected.y_m, expected.yaw_rad))


def test_a_study_reads_back_from_its_json() -> None:
    found = study(
        garments=[{"random": 2, "seed": 1}, {"template": "towel", "measures": {"width_m": 0.4}}],
        placements=[{"x_m": 0.1, "y_m": 0.2, "yaw_rad": 0.3}],
        start_stations=["front", "left"],
        sample={"cells": 3},
    )
    again = Study.from_dict(json.loads(json.dumps(found.to_dict())))
    assert again == found
    assert again.digest == found.digest


@pytest.mark.parametrize(
    ("changes", "field", "told"),
    [
        ({"colour": 1}, "colour", "known"),
        ({"garments": []}, "garments", "[[garments]]"),
        ({"garments": [{}]}, "garments[0]", "nothing"),
        ({"garments": [{"name": "sock"}]}, "garments[0].name", "sock"),
        ({"garments": [{"file": "a.json"}]}, "garments[0].file", "not read here"),
        ({"garments": [{"garment": {"name": "x"}}]}, "garments[0].garment.outline", "missing"),
        ({"garments": [{"template": "towel", "measures": {"wide_m": 1}}]}, "garments[0].measures.wide_m", "known"),
        (
            {"garments": [{"template": "towel", "measures": {"width_m": [0.4, -1]}}]},
            "garments[0].measures.width_m",
            "-1",
        ),
        ({"garments": [{"random": 3}]}, "garments[0].seed", "missing"),
        ({"garments": [{"random": 0, "seed": 1}]}, "garments[0].random", "0"),
        ({"garments": [{"random": 3, "seed": 1, "folds": [3, 1]}]}, "garments[0].folds", "[3, 1]"),
        ({"robots": ["r2d2"]}, "robots[0]", "r2d2"),
        ({"robots": ["pr2", "pr2"]}, "robot", "'pr2'"),
        ({"table": {"height_m": []}}, "table.height_m", "0 values"),
        ({"table": {"height_m": [0.7, True]}}, "table.height_m[1]", "True"),
        ({"table": {"height_m": [0.7, 50.0]}}, "table.height_m", "50"),
        ({"table": {"height_m": [0.7, 0.7]}}, "table.height_m", "0.7"),
        ({"table": {"height_m": {"from": 0.7, "to": 0.8}}}, "table.height_m", "step or count"),
        ({"table": {"height_m": {"from": 0.7, "to": 0.8, "step": 0}}}, "table.height_m.step", "0"),
        ({"table": {"height_m": {"from": 0.7, "to": 0.8, "by": 1}}}, "table.height_m.by", "known"),
        ({"scene": {"friction": "low"}}, "scene.friction", "'low'"),
        ({"scene": {"friction": [-1.0]}}, "scene.friction", "-1"),
        ({"scene": {"stations": {"front": {"x_m": 0}}}}, "scene.stations.front.y_m", "missing"),
        ({"placements": [{"x_m": 0, "y_m": 0}]}, "placements[0].yaw_rad", "missing"),
        ({"placements": {"moved": {"z_m": 0}}}, "placements.moved.z_m", "known"),
        ({"placements": {}}, "placements", "one of"),
        ({"start_stations": ["moon"]}, "start_stations[0]", "moon"),
        ({"limits": {"comfort_radius_m": [0.5]}}, "limits.comfort_radius_m", "0.5"),
        ({"limits": {"heuristic": ["best"]}}, "limits.heuristic[0]", "best"),
        ({"limits": {"max_expanded": [1.5]}}, "limits.max_expanded", "1.5"),
        ({"card": {"mounts": {"9": {"y_m": 0.1}}}}, "card.mounts.9.y_m", "no field"),
        ({"card": {"scene.table.height_m": -1}}, "card.scene.table.height_m", "-1"),
        ({"card": {"title": "x"}}, "card.title", "'x'"),
        ({"sample": {"cells": 0}}, "sample.cells", "0"),
        ({"cells_max": 3}, "cells_max", "4 cells (4 table.height_m)"),
        ({"comfort_margin": 1}, "comfort_margin", "neither true nor false"),
        ({"rehearsal": {"noise": ["loud"]}}, "rehearsal.noise[0]", "'loud'"),
        ({"rehearsal": {"noise": []}}, "rehearsal.noise", "0 values"),
        ({"rehearsal": {"runs": 0}}, "rehearsal.runs", "0"),
        ({"rehearsal": {"seed": -1}}, "rehearsal.seed", "-1"),
        ({"rehearsal": {"feedback": "on"}}, "rehearsal.feedback", "neither true nor false"),
        ({"rehearsal": {"sound": 1}}, "rehearsal.sound", "known"),
    ],
)
def test_what_is_wrong_is_told_with_field_and_value(changes: dict[str, Any], field: str, told: str) -> None:
    with pytest.raises(StudyError) as caught:
        study(**changes)
    assert caught.value.field == field
    assert told in caught.value.message


@pytest.mark.parametrize(("text", "told"), [("garments = [", "TOML"), (None, "cannot be read")])
def test_a_file_that_is_no_toml_is_told(tmp_path: Path, text: str | None, told: str) -> None:
    path = tmp_path / "study.toml"
    if text is not None:
        path.write_text(text)
    with pytest.raises(StudyError, match=told):
        read_study(path)


ALL_FIELDS = """
title = "Everything"
robots = ["so101-pair"]
start_stations = ["front"]
cells_max = 50
comfort_margin = true
[[garments]]
template = "towel"
measures.width_m = [0.2, 0.3]
[card]
mounts.0.y_m = [0.15, 0.2]
[table]
depth_m = { from = 0.5, to = 0.6, count = 2 }
[scene]
friction = [0.5, 1.0]
[placements.moved]
x_m = [0.0, 0.1]
[limits]
comfort_radius_m = 0.01
[sample]
cells = 5
seed = 2
[rehearsal]
noise = ["none", "real"]
runs = 2
"""


def test_a_request_in_json_has_every_field_of_a_file_and_says_the_same_study() -> None:
    written = tomllib.loads(ALL_FIELDS)
    assert set(written) == set(FIELDS), "a field is missing above"
    wanted = STUDIES.form.read(json.loads(json.dumps(written)))
    nowhere = SimpleNamespace(garments=SimpleNamespace(garment=load_garment), studies=SimpleNamespace(folder=Path()))
    asked, _ = STUDIES.prepare(cast(Stores, nowhere), wanted)
    assert asked == study_of(written, Sources())
    assert asked.count == 5


def test_the_documentation_names_every_field() -> None:
    text = (Path(__file__).parents[3] / "docs" / "studies.md").read_text(encoding="utf-8")
    rows = text.partition("## The file")[2].partition("##")[0].splitlines()
    named = [name for row in rows if row.startswith("| `") for name in re.findall(r"`(\w+)`", row.split("|")[1])]
    assert sorted(named) == sorted(FIELDS)
