import csv
import gzip
import json
import sqlite3
from collections.abc import Generator, Iterable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from pyarrow import parquet

from app.studies.answer import Answer
from app.studies.cell import Cell
from app.studies.fields import StudyFolderError
from app.studies.results import FILE, Results
from app.studies.run_study import Progress, run_study
from app.studies.study import Study
from app.studies.table import CSV, PARQUET, TIMING
from app.studies.workers import InProcess, Workers
from planner.task.plan import Plan
from planner.task.task import Task
from tests.app.studies.planners import fake_plan, late, raising
from tests.app.studies.study_samples import HEIGHTS, study

MANY = {"table": {"height_m": {"from": 0.5, "to": 1.0, "count": 51}}}


class Interrupting:
    """Workers that are interrupted after some answers, as by Ctrl-C."""

    def __init__(self, after: int) -> None:
        self._left = after

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        for answer in InProcess(fake_plan).answers(cells, keep_plans=keep_plans):
            if not self._left:
                raise KeyboardInterrupt
            self._left -= 1
            yield answer


def run(asked: Study, folder: Path, workers: Workers | None = None, *, resume: bool = True, **options: Any) -> Progress:
    with Results(folder) as results:
        results.begin(asked, resume=resume)
        return run_study(asked, results, workers or InProcess(fake_plan), lambda _: None, **options)


def rows(folder: Path) -> list[dict[str, Any]]:
    return list(parquet.read_table(folder / PARQUET).to_pylist())


def files(folder: Path) -> list[bytes]:
    return [(folder / name).read_bytes() for name in (PARQUET, CSV, "report.html")]


def test_the_table_has_a_row_for_each_cell_in_order(tmp_path: Path) -> None:
    run(study(), tmp_path)
    table = rows(tmp_path)
    assert [row["cell"] for row in table] == [0, 1, 2, 3]
    assert [row["table.height_m"] for row in table] == HEIGHTS
    assert [row["status"] for row in table] == ["solved", "solved", "infeasible", "infeasible"]
    assert [row["cost_s"] for row in table] == [0.0, 0.0, None, None]
    assert len({row["plan_id"] for row in table}) == 4
    with (tmp_path / CSV).open() as text:
        assert [line["status"] for line in csv.DictReader(text)] == [row["status"] for row in table]


def test_a_row_tells_what_the_plan_has_to_spare(tmp_path: Path) -> None:
    # The upper table is out of reach. Margins of a plan for a radius of 2 cm are at least that.
    changes = {"table": {"height_m": [0.7, 1.9]}, "limits": {"work_limit_s": 1.0, "comfort_radius_m": 0.02}}
    run(study(**changes), tmp_path / "read", InProcess())
    solved, refused = rows(tmp_path / "read")
    assert (solved["status"], refused["status"]) == ("solved", "infeasible")
    assert 0.019 <= solved["reach_margin_m"] <= 0.1
    assert solved["friction_margin"] == 1.0 and solved["edge_margin_m"] > 0.0
    names = ("reach_margin_m", "reach_margin_step", "grips_margin_m", "friction_margin", "edge_margin_m")
    assert [refused[name] for name in names] == [None] * 5
    assert "comfort_margin_m" not in solved


def test_the_margin_that_takes_further_plans_is_there_where_it_is_asked_for(tmp_path: Path) -> None:
    changes = {"table": {"height_m": [0.7, 1.9]}, "limits": {"work_limit_s": 1.0, "comfort_radius_m": 0.02}}
    asked = study(**changes, comfort_margin=True)
    assert Study.from_dict(asked.to_dict()) == asked and asked.digest != study(**changes).digest
    run(asked, tmp_path, InProcess())
    solved, refused = rows(tmp_path)
    assert solved["comfort_margin_m"] >= 0.02 and refused["comfort_margin_m"] is None
    tighter = {"work_limit_s": 1.0, "comfort_radius_m": solved["comfort_margin_m"]}
    run(study(table={"height_m": [0.7]}, limits=tighter), tmp_path / "again", InProcess())
    assert rows(tmp_path / "again")[0]["status"] == "solved"
    with pytest.raises(StudyFolderError, match="comfort_margin"):
        run(study(**changes), tmp_path)


def test_times_are_in_a_file_of_their_own(tmp_path: Path) -> None:
    run(study(), tmp_path)
    with (tmp_path / TIMING).open() as text:
        lines = list(csv.DictReader(text))
    assert [float(line["wall_s"]) >= 0.0 for line in lines] == [True] * 4
    assert not {"wall_s", "cpu_s"} & rows(tmp_path)[0].keys()


def test_a_study_that_is_interrupted_five_times_gives_the_table_of_one_that_is_not(tmp_path: Path) -> None:
    asked = study(**MANY)
    run(asked, tmp_path / "whole")
    for _ in range(5):
        with pytest.raises(KeyboardInterrupt):
            run(asked, tmp_path / "parts", Interrupting(after=7))
    last = run(asked, tmp_path / "parts")
    assert last.begun_with == 35
    assert files(tmp_path / "parts") == files(tmp_path / "whole")


def test_a_study_that_is_done_plans_nothing_again(tmp_path: Path) -> None:
    run(study(), tmp_path)
    before = files(tmp_path)
    end = run(study(), tmp_path, Interrupting(after=0))
    assert (end.done, end.begun_with) == (4, 4)
    assert files(tmp_path) == before


def test_a_cell_that_fails_is_a_row_with_its_error(tmp_path: Path) -> None:
    end = run(study(), tmp_path, InProcess(raising))
    assert (end.done, end.failed) == (4, 1)
    failed = rows(tmp_path)[1]
    assert (failed["status"], failed["error"]) == ("failed", "ValueError: the planner stumbles")
    assert [row["status"] for row in rows(tmp_path)].count("failed") == 1


def test_failed_cells_can_be_planned_again_alone(tmp_path: Path) -> None:
    run(study(), tmp_path, InProcess(raising))
    with Results(tmp_path) as results:
        results.forget_failed()
    end = run(study(), tmp_path)
    assert (end.begun_with, end.done) == (3, 4)
    assert rows(tmp_path)[1]["status"] == "solved"


def test_a_cell_that_the_clock_ended_says_so(tmp_path: Path) -> None:
    run(study(table={}, limits={"time_limit_s": 0.01}), tmp_path, InProcess(late))
    row = rows(tmp_path)[0]
    assert (row["status"], row["error"]) == ("budget_exceeded", "the time limit of 0.01 s ended the search")


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"table": {"height_m": [0.7]}}, "table.height_m"),
        ({"garments": [{"name": "tie"}]}, "garment"),
        ({"sample": {"cells": 2}}, "sample"),
    ],
)
def test_a_study_that_changed_is_told_what_changed(tmp_path: Path, changes: dict[str, Any], told: str) -> None:
    run(study(), tmp_path)
    with pytest.raises(StudyFolderError, match=told):
        run(study(**changes), tmp_path)
    assert run(study(**changes), tmp_path, resume=False).begun_with == 0
    assert [row["cell"] for row in rows(tmp_path)] == list(study(**changes).indices())


def test_a_new_title_is_no_change(tmp_path: Path) -> None:
    run(study(), tmp_path)
    assert run(study(title="Another"), tmp_path).begun_with == 4


def test_two_studies_at_once_in_one_folder_are_refused(tmp_path: Path) -> None:
    with Results(tmp_path), pytest.raises(StudyFolderError, match="under way"):
        Results(tmp_path)


def test_a_file_that_is_no_database_is_told(tmp_path: Path) -> None:
    (tmp_path / FILE).write_bytes(b"something else " * 100)
    with pytest.raises(StudyFolderError, match="no results"):
        Results(tmp_path)


def test_only_the_cells_that_are_missing_are_planned(tmp_path: Path) -> None:
    run(study(), tmp_path)
    before = files(tmp_path)
    with closing(sqlite3.connect(tmp_path / FILE)) as file:
        file.execute("DELETE FROM answer WHERE cell = 2")
        file.commit()
    end = run(study(), tmp_path)
    assert (end.begun_with, end.done) == (3, 4)
    assert files(tmp_path) == before


def test_work_that_is_told_to_stop_keeps_what_it_has(tmp_path: Path) -> None:
    end = run(study(), tmp_path, should_stop=lambda: True)
    assert end.done == 1
    assert len(rows(tmp_path)) == 1


def test_the_real_planner_gives_the_same_table_in_any_order(tmp_path: Path) -> None:
    class Backwards:
        def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
            yield from InProcess().answers(reversed(list(cells)), keep_plans=keep_plans)

    asked = study(table={"height_m": [0.7, 5.0]}, limits={"work_limit_s": 1.0, "comfort_radius_m": [0.0, 0.03]})
    run(asked, tmp_path / "one", InProcess())
    run(asked, tmp_path / "other", Backwards())
    assert files(tmp_path / "one") == files(tmp_path / "other")
    assert [row["status"] for row in rows(tmp_path / "one")] == ["solved"] * 2 + ["infeasible"] * 2
    assert rows(tmp_path / "one")[2]["reason_codes"]


def test_plans_are_kept_where_they_are_wanted(tmp_path: Path) -> None:
    run(study(table={}), tmp_path, InProcess(), keep_plans=True)
    name = rows(tmp_path)[0]["plan_id"]
    kept = json.loads(gzip.decompress((tmp_path / "plans" / f"{name}.plan.json.gz").read_bytes()))
    plan = Plan.from_dict(kept)
    assert plan.cost_s == rows(tmp_path)[0]["cost_s"]
    assert Task.from_dict(kept["task"]) == study(table={}).cell(0).task
