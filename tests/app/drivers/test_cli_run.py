"""``pleat run``: what it asks, prints and ends with."""

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from app.cli import cli
from app.drivers import simulated
from planner import Plan
from planner.task.plan_files import write_plan
from tests.app.drivers.manual_clock import ManualClock


@pytest.fixture
def file(plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return a plan file; waits take no time."""
    monkeypatch.setattr(simulated, "RealClock", ManualClock)
    write_plan(plan, tmp_path / "napkin.plan.json")
    return str(tmp_path / "napkin.plan.json")


def pleat(*arguments: str, typed: str = "") -> Result:
    return CliRunner().invoke(cli, arguments, input=typed)


def test_a_plan_is_run_without_a_robot_and_recorded(file: str, plan: Plan, tmp_path: Path) -> None:
    record = tmp_path / "run.mcap"
    result = pleat("run", file, "--driver", "simulated", "--auto", "--speed", "0.3", "--record", str(record))
    assert result.exit_code == 0, result.output
    assert f"Done: {len(plan.steps)} of {len(plan.steps)} steps" in result.stdout
    assert record.read_bytes().startswith(b"\x89MCAP0")


def test_a_step_that_is_declined_ends_the_run_with_status_3(file: str, plan: Plan) -> None:
    result = pleat("run", file, typed="y\nn\n")
    assert result.exit_code == 3
    assert f"Stopped after 1 of {len(plan.steps)} steps" in result.stderr
    assert "step 0: " in result.stderr and "step 1: " in result.stderr


def test_the_end_of_the_input_stops_like_ctrl_c(file: str) -> None:
    result = pleat("run", file)
    assert result.exit_code == 3 and "Stopped after 0" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--speed", "0.01"), "--speed: expected 0.05 to 1, got 0.01"),
        (("--from-step", "9"), "--from-step: 9 is not between 0 and"),
        (("--driver", "ur"), "ur drives arms of Universal Robots"),
        (("--driver", "lerobot", "--address", "left"), "--address: expected ARM=WHERE"),
        (("--driver", "ros2", "--address", "ws://127.0.0.1:1"), "rosbridge is not at ws://127.0.0.1:1"),
        (("--driver", "telepathy"), "telepathy"),
    ],
)
def test_bad_usage_is_status_2_naming_what_is_wrong(file: str, arguments: tuple[str, ...], told: str) -> None:
    result = pleat("run", file, "--auto", *arguments)
    assert result.exit_code == 2 and told in result.stderr
    assert "Traceback" not in result.output
