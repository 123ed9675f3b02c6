import json
from pathlib import Path

import pytest

from app.rehearsal.judge import StepVerdict
from app.rehearsal.result import RehearsalResult, Run
from planner.task.plan_files import write_plan
from tests.app.rehearsal.towel import towel_plan
from tests.app.test_cli import pleat


@pytest.mark.parametrize("option", [("--runs", "0"), ("--seed", "-1"), ("--noise", "loud"), ("--robot", "ur5e-pair")])
def test_an_option_that_cannot_be_is_refused_by_its_name(option: tuple[str, str], tmp_path: Path) -> None:
    path = tmp_path / "towel.plan.json"
    write_plan(towel_plan(), path)
    refused = pleat("rehearse", str(path), *option)
    assert refused.exit_code == 2
    assert option[0] in refused.stderr


def test_each_step_is_named_as_in_the_plan_also_after_the_rest_was_planned_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Two steps of another plan were made: the second one leaves the towel folded as the plan's only step does.
    path = tmp_path / "towel.plan.json"
    write_plan(towel_plan(), path)
    verdicts = tuple(StepVerdict(step, 0.9, 1.0, 2.0, 3.0, 4.0, 0.0, of_plan=of) for step, of in ((0, None), (1, 0)))
    monkeypatch.setattr("app.cli.rehearse.rehearse", lambda *_: RehearsalResult((Run(0, verdicts),)))
    lines = pleat("rehearse", str(path)).stdout.splitlines()
    rows = [line.split() for line in lines if "held" in line and "0.900" in line]
    assert [(row[1], "half" in row) for row in rows] == [("0", False), ("1", True)]


@pytest.mark.long
def test_a_towel_is_rehearsed_from_its_plan_file(tmp_path: Path) -> None:
    path = tmp_path / "towel.plan.json"
    write_plan(towel_plan(), path)
    done = pleat("rehearse", str(path), "--json", "-")
    result = json.loads(done.stdout)
    assert done.exit_code == (0 if result["held"] == 1 else 3)
    assert result["of"] == 1
    (run,) = result["runs"]
    assert {"held", "steps", "final_iou", "regrasps", "repairs", "replans"} <= run.keys()
    (step,) = run["steps"]
    assert {"step", "iou", "mean_mm", "p95_mm", "held"} <= step.keys()
    assert run["final_iou"] == step["iou"] > 0.9
