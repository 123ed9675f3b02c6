from pathlib import Path
from typing import Any

import pytest
from pyarrow import parquet

from app.rehearsal.rehearse import rehearse
from app.studies.answer import answered
from app.studies.fields import StudyError
from app.studies.findings import Findings
from app.studies.results import Results
from app.studies.run_study import run_study
from app.studies.study import Study
from app.studies.table import PARQUET
from app.studies.workers import LocalWorkers, planner
from tests.app.rehearsal.test_rehearsal_routes import NAPKIN
from tests.app.studies.planners import fake_plan
from tests.app.studies.study_samples import study

REHEARSED = {
    "garments": [{"garment": NAPKIN}],
    "table": {"height_m": [0.75, 1.9]},
    "rehearsal": {"noise": ["none", "real"], "seed": 3},
}
"""A napkin on a table and on one that is too high, performed once without noise and once with it."""


@pytest.mark.long
def test_noise_is_an_axis_and_every_solved_plan_is_performed_with_it(tmp_path: Path) -> None:
    asked = study(**REHEARSED)
    with Results(tmp_path) as results:
        results.begin(asked, resume=True)
        run_study(asked, results, LocalWorkers(2), lambda _: None)
        findings = Findings(asked, results)
    table = parquet.read_table(tmp_path / PARQUET).to_pylist()
    assert [row["rehearsal.noise"] for row in table] == ["none", "real"] * 2
    assert [row["status"] for row in table] == ["solved", "solved", "infeasible", "infeasible"]
    assert [row["rehearsal_seed"] for row in table] == [3, 3, None, None]
    assert [row["runs"] for row in table] == [1, 1, None, None]
    assert [row["runs_held"] for row in table[2:]] == [row["final_iou"] for row in table[2:]] == [None, None]
    exact, noisy = table[:2]
    # Noise moves the cloth by a centimetre, so that the two outlines differ; without it the napkin is folded well.
    assert exact["runs_held"] == 1 and exact["final_iou"] > 0.9
    assert noisy["final_iou"] != exact["final_iou"]
    for row in (exact, noisy):
        assert 0.0 <= row["success_low"] < row["success_high"] <= 1.0
    cell = asked.cell(0)
    assert cell.task is not None and cell.rehearsal is not None
    result = rehearse(planner()(cell.task), cell.rehearsal)
    assert result.runs[0].steps[-1].iou == exact["final_iou"], "a row depends on its cell alone"
    names = [axis.name for axis in findings.axes]
    held = findings.held_by(0, names.index("rehearsal.noise"))
    assert held.cells.tolist() == [[1, 1]]
    assert held.solved.tolist() == [[exact["runs_held"], noisy["runs_held"]]]
    assert "<h2>What holds</h2>" in (tmp_path / "report.html").read_text()


def test_a_study_without_rehearsals_has_no_columns_of_them() -> None:
    asked = study()
    assert asked.rehearsal is None and asked.cell(0).rehearsal is None
    assert "runs" not in answered(asked.cell(0), fake_plan).row


def test_a_study_with_rehearsals_reads_back_and_other_runs_are_another_study() -> None:
    asked = study(**REHEARSED)
    again = Study.from_dict(asked.to_dict())
    assert again == asked
    more: dict[str, Any] = {**REHEARSED, "rehearsal": {**REHEARSED["rehearsal"], "runs": 2}}  # type: ignore[dict-item]
    assert study(**more).digest != asked.digest


def test_each_run_counts_as_a_cell(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match="40 runs"):
        study(rehearsal={"runs": 40}, cells_max=100)


def test_without_the_physics_the_file_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.distribution.is_installed", lambda _: False)
    with pytest.raises(StudyError, match="MuJoCo"):
        study(rehearsal={})
