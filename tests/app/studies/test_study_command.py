import json
from html.parser import HTMLParser
from pathlib import Path

import pytest
from pyarrow import parquet
from typer.testing import CliRunner, Result

from app.cli import cli
from app.studies.results import Results
from planner.task.plan_files import read_plan

FILE = """
title = "Towels <on> tables"
[[garments]]
template = "towel"
measures = {width_m = 0.3, length_m = [0.2, 0.25]}
[table]
height_m = [0.7, 5.0]
[limits]
work_limit_s = 1
comfort_radius_m = 0.0
"""


def pleat(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a study that has been run."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "study.toml").write_text(FILE)
    result = pleat("study", folder / "study.toml", "--out", folder, "--workers", 1)
    assert result.exit_code == 0, result.output
    assert "4 cells" in result.stdout
    return folder


def test_a_study_leaves_a_table_a_report_and_its_times(done: Path) -> None:
    assert {"table.parquet", "table.csv", "timing.csv", "report.html"} <= {path.name for path in done.iterdir()}
    statuses = parquet.read_table(done / "table.parquet").column("status").to_pylist()
    assert statuses == ["solved", "infeasible"] * 2


def test_the_plan_of_a_cell_is_made_again(done: Path) -> None:
    target = done / "cell.plan.json"
    assert pleat("study-plan", done, 2, "--out", target).exit_code == 0
    row = parquet.read_table(done / "table.parquet").to_pylist()[2]
    assert read_plan(target).cost_s == row["cost_s"]
    assert "between 0 and 3" in pleat("study-plan", done, 4, "--out", target).stderr


def test_the_report_is_whole_html_that_fetches_nothing(done: Path) -> None:
    page = (done / "report.html").read_text()

    class Reader(HTMLParser):
        def __init__(self) -> None:
            super().__init__()
            self.open: list[str] = []
            self.addresses: list[str] = []

        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            if tag != "meta":
                self.open.append(tag)
            self.addresses += [str(value) for name, value in attrs if name in ("src", "href", "action")]

        def handle_endtag(self, tag: str) -> None:
            assert self.open.pop() == tag

    reader = Reader()
    reader.feed(page)
    assert (reader.open, reader.addresses) == ([], [])
    assert "<script" not in page
    assert "@import" not in page
    assert "Towels &lt;on&gt; tables" in page
    for heading in ("Who folds what", "What folds most garments", "Where it flips", "Why not"):
        assert heading in page


def test_the_same_command_again_plans_nothing(done: Path) -> None:
    before = (done / "table.parquet").read_bytes()
    assert pleat("study", done / "study.toml", "--out", done).exit_code == 0
    assert (done / "table.parquet").read_bytes() == before


def test_a_file_that_changed_is_told(done: Path, tmp_path: Path) -> None:
    (tmp_path / "other.toml").write_text(FILE.replace("0.25", "0.3"))
    result = pleat("study", tmp_path / "other.toml", "--out", done)
    assert result.exit_code == 2
    assert "has changed: the values of garment" in result.stderr


def test_a_folder_in_use_is_told(done: Path) -> None:
    with Results(done):
        result = pleat("study", done / "study.toml", "--out", done)
    assert (result.exit_code, "under way" in result.stderr) == (2, True)


def test_the_cells_can_be_counted_alone(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(FILE + "[sample]\ncells = 3\n")
    result = pleat("study", tmp_path / "study.toml", "--out", tmp_path / "out", "--count")
    assert "3 cells, drawn from 4 (2 garment x 2 table.height_m)" in result.stdout
    assert not (tmp_path / "out").exists()


def test_what_is_wrong_names_file_field_and_number(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(FILE.replace("5.0", "50.0"))
    result = pleat("study", tmp_path / "study.toml", "--out", tmp_path)
    assert result.exit_code == 2
    assert "study.toml: table.height_m: 50.0 is not between 0.1 and 10" in result.stderr
    (tmp_path / "garment.json").write_text(json.dumps({"name": "x"}))
    (tmp_path / "study.toml").write_text('[[garments]]\nfile = "garment.json"\n')
    assert "garments[0].file" in pleat("study", tmp_path / "study.toml", "--out", tmp_path).stderr


def test_processes_and_a_scheduler_are_not_both_wanted(tmp_path: Path) -> None:
    result = pleat("study", tmp_path / "s.toml", "--out", tmp_path, "--workers", 2, "--scheduler", "tcp://x:1")
    assert (result.exit_code, "--workers" in result.stderr) == (2, True)
