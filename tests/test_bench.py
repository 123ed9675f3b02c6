"""The benchmark: its tables, its JSON, and the figures it takes from the paper. No time is ever judged."""

import json
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from bench.__main__ import BENCHMARKS, main
from bench.heuristics import heuristics
from bench.measurement import Case, Ratio, measure
from bench.paper import TABLE_1, TABLE_2
from bench.paper_tables import table_1, table_2
from bench.report import Report
from bench.yes_and_no import yes_and_no

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
    "search_time_s",
    "plan_time_s",
}


def written(report: Report, folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(report.write(folder).read_text(encoding="utf-8"))
    return content


def printed(report: Report) -> str:
    console = Console(width=200)
    with console.capture() as capture:
        console.print(report.to_table())
    return capture.get()


def test_the_papers_figures_are_those_of_its_tables():
    assert (TABLE_1["t-shirt"].primitives, TABLE_1["t-shirt"].cost_s) == (7, 48.12)
    assert (TABLE_1["skirt"].expanded, TABLE_1["skirt"].explored, TABLE_1["skirt"].ik_queries) == (60, 535, 10087)
    assert (TABLE_1["hand-towel"].search_time_s, TABLE_1["hand-towel"].ik_time_s) == (5.04, 1.90)
    assert (TABLE_2["shirt"].search_time_s, TABLE_2["shirt"].ik_time_s) == (121.70, 85.99)
    assert (TABLE_2["jeans"].explored, TABLE_2["jeans"].ik_queries) == (60, 272)
    assert (TABLE_2["hand-towel"].expanded, TABLE_2["hand-towel"].overhead_s) == (17, 0.004)


def test_both_tables_of_the_paper_have_the_same_plans_of_the_nine_articles():
    # In the paper the comfort radius changes the search only, not one plan.
    plans_1, plans_2 = (
        {name: (row.folds, row.primitives, row.cost_s) for name, row in table.items()} for table in (TABLE_1, TABLE_2)
    )
    assert len(plans_1) == 9
    assert plans_1 == plans_2


@pytest.mark.parametrize(("build", "comfort_m", "paper"), [(table_1, 0.0, TABLE_1), (table_2, 0.03, TABLE_2)])
def test_a_table_has_our_row_above_the_papers(build, comfort_m, paper, tmp_path: Path):
    report = build(["hand-towel"], 1)
    assert [[line[1] for line in row.lines] for row in report.rows] == [["Pleat", "paper"]]
    assert all(len(line) == len(report.columns) for row in report.rows for line in row.lines)
    assert report.to_table().row_count == 2
    assert "search [s]" in printed(report)

    (row,) = written(report, tmp_path)["rows"]
    assert row["article"] == "hand-towel"
    assert set(row["pleat"]) == MEASURED
    assert row["pleat"]["comfort_radius_m"] == comfort_m
    assert row["pleat"]["status"] == "solved"
    assert row["pleat"]["folds"] == row["paper"]["folds"] == 3
    assert row["paper"]["search_time_s"] == paper["hand-towel"].search_time_s


def test_a_report_says_what_it_was_run_on(tmp_path: Path):
    content = written(Report("empty", "Nothing", ("a",), (), 1), tmp_path)
    assert (tmp_path / "empty.json").exists()
    assert set(content) == {"name", "title", "repetitions", "source", "environment", "rows"}
    assert set(content["environment"]) == {"cores", "architecture", "system", "python", "libraries"}
    assert content["environment"]["cores"] >= 1
    assert {"numba", "pin", "shapely"} <= set(content["environment"]["libraries"])


def test_the_heuristic_saves_expansions_at_the_same_cost(tmp_path: Path):
    (row,) = written(heuristics(["hand-towel"], 1), tmp_path)["rows"]
    assert row["arm_time"]["cost_s"] == pytest.approx(row["zero"]["cost_s"])
    assert row["expanded_ratio"] >= 1
    assert set(row["search_time_ratio"]) == {"median", "least", "most"}


def test_repetitions_come_out_the_same():
    first, second = measure(Case("hand-towel", 0.0), Case("hand-towel", 0.0), repetitions=2)
    assert first.outcome == second.outcome
    assert len(first.search_times_s) == 2


def test_a_ratio_is_the_median_of_the_turns():
    # 2/1, 9/3, 4/4
    assert Ratio.of([2, 9, 4], [1, 3, 4]) == Ratio(median=2, least=1, most=3)


def test_a_garment_without_a_peer_is_left_out():
    assert yes_and_no(["hand-towel"], 1).rows == ()


def test_only_what_is_asked_for_is_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    main(["--quick", "--only", "table-1", "first-plan", "hand-towel"], tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"table-1.json", "first-plan.json"}
    (row,) = json.loads((tmp_path / "first-plan.json").read_text(encoding="utf-8"))["rows"]
    assert set(row) == {"article", "import_s", "first_plan_s", "second_plan_s", "plan_time_ratio"}
    assert "hand-towel" in capsys.readouterr().out


def test_a_name_that_is_no_table_and_no_garment_is_refused(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit) as exit_:
        main(["--only", "socks"])
    assert exit_.value.code == 2
    message = capsys.readouterr().err
    assert all(name in message for name in ("socks", *BENCHMARKS))
