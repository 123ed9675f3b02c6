import json
import socket
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import pytest
from typer.main import get_group
from typer.testing import CliRunner, Result

from app.cli import cli
from app.cli.commands import COMMANDS, loaded
from tests.app.samples import towel


def pleat(*arguments: str) -> Result:
    return CliRunner().invoke(cli, arguments)


def saved(tmp_path: Path, garment: object) -> str:
    path = tmp_path / "towel.json"
    path.write_text(json.dumps(garment))
    return str(path)


def test_a_plan_is_printed_as_a_table(tmp_path: Path) -> None:
    result = pleat("plan", saved(tmp_path, towel()))
    assert result.exit_code == 0
    for heading in ("primitive", "what", "start", "duration", "base", "grips", "fold"):
        assert heading in result.stdout


def test_json_to_standard_output_comes_alone(tmp_path: Path) -> None:
    result = pleat("plan", saved(tmp_path, towel()), "--json", "-")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["status"] == "solved"


def test_json_can_go_into_a_file(tmp_path: Path) -> None:
    target = tmp_path / "plan.json"
    result = pleat("plan", saved(tmp_path, towel()), "--json", str(target))
    assert result.exit_code == 0
    assert json.loads(target.read_text())["status"] == "solved"
    assert "primitive" in result.stdout


def test_no_plan_is_status_3_with_the_reasons(tmp_path: Path) -> None:
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps({"stations": {"front": {"x_m": -3.0, "y_m": 0.0, "yaw_rad": 0.0}}}))
    result = pleat("plan", saved(tmp_path, towel()), "--scene", str(scene), "--json", "-")
    assert result.exit_code == 3
    assert json.loads(result.stdout)["status"] == "infeasible"
    assert "out_of_reach" in result.stderr


def test_an_exhausted_budget_is_status_4() -> None:
    result = pleat("plan", "shirt", "--time-limit-s", "0.01")
    assert result.exit_code == 4
    assert "Raise --time-limit-s" in result.stderr


@pytest.mark.parametrize("command", ["plan", "dag", "check"])
def test_a_bad_garment_is_status_2_naming_file_field_and_fault(tmp_path: Path, command: str) -> None:
    path = saved(tmp_path, towel(outline=[[0, 0], [1, 0]]))
    result = pleat(command, path)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "towel.json" in result.stderr
    assert "outline" in result.stderr
    assert "2 points" in result.stderr


@pytest.mark.parametrize("command", ["plan", "dag", "check"])
@pytest.mark.parametrize("name", ["nothing", "missing.json", "."])
def test_an_unknown_garment_is_status_2(command: str, name: str) -> None:
    result = pleat(command, name)
    assert result.exit_code == 2
    assert name in result.stderr
    assert "Traceback" not in result.output


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("fly",),
        ("plan",),
        ("plan", "tie", "--heuristic", "magic"),
        ("plan", "tie", "--time-limit-s", "soon"),
        ("plan", "tie", "--time-limit-s", "nan"),
        ("plan", "tie", "--start", "nowhere"),
        ("plan", "tie", "--comfort-radius-m", "1"),
        ("plan", "tie", "--scene", "missing.json"),
        ("plan", "letter-towel", "--json", "/nowhere/at/all.json"),
        ("serve", "--port", "70000"),
        ("serve", "--host", "not an address"),
    ],
)
def test_wrong_usage_is_status_2(arguments: tuple[str, ...]) -> None:
    result = pleat(*arguments)
    assert result.exit_code == 2
    assert "Traceback" not in result.output


@pytest.mark.parametrize("option", ["--json", "--out"])
def test_a_folder_that_is_missing_is_named_before_anything_is_planned(
    option: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.cli.plan.make_plan", lambda _: pytest.fail("it was planned"))
    result = pleat("plan", "letter-towel", option, "/nowhere/at/all.json")
    assert (result.exit_code, result.stderr) == (2, "/nowhere/at/all.json: No such file or directory\n")


def test_a_port_that_is_taken_is_named(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = pleat("serve", "--port", str(port), "--data", str(tmp_path))
    assert result.exit_code == 2
    assert f"127.0.0.1:{port}" in result.stderr


def test_the_wrong_option_is_named() -> None:
    assert "--start" in pleat("plan", "tie", "--start", "nowhere").stderr


def test_the_version_is_that_of_the_project(monkeypatch: pytest.MonkeyPatch) -> None:
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    result = pleat("--version")
    assert (result.exit_code, result.stdout) == (0, project["version"] + "\n")

    def missing(name: str) -> str:
        raise PackageNotFoundError(name)

    monkeypatch.setattr("app.distribution.version", missing)
    assert pleat("--version").stdout == project["version"] + "\n"


def test_a_robot_with_one_gripper_cannot_hold_what_needs_two() -> None:
    assert pleat("check", "hand-towel").exit_code == 0
    result = pleat("check", "hand-towel", "--robot", "ur5e-single")
    assert result.exit_code == 3 and "cannot hold" in result.stderr
    assert "--robot" in pleat("check", "hand-towel", "--robot", "r2d2").stderr


def test_dag_prints_edges(tmp_path: Path) -> None:
    table = pleat("dag", "t-shirt")
    assert table.exit_code == 0
    assert "waits for" in table.stdout
    answer = json.loads(pleat("dag", "t-shirt", "--json", "-").stdout)
    assert sorted(map(tuple, answer["edges"])) == [(0, 2), (1, 3), (2, 4), (3, 4)]


def test_check_says_whether_each_fold_can_be_held() -> None:
    result = pleat("check", "t-shirt")
    assert result.exit_code == 0
    assert "left sleeve" in result.stdout


def test_check_says_of_every_corner_whether_it_must_be_held_and_why() -> None:
    words = " ".join(pleat("check", "vest").stdout.replace("│", " ").split())
    assert "outline of 9 points, 0.508 x 0.610 m" in words
    assert "(0.051, 0.610): must be held, hanging freely: nothing above" in words
    assert "(0.254, 0.000) (0.254, 0.406): need not, on the fold line" in words
    assert "(0.102, 0.610): need not, held by the cloth above" in words
    assert "a grip holds what is within" in words


def test_check_as_json_comes_alone() -> None:
    result = pleat("check", "letter-towel", "--json", "-")
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert answer["is_holdable"] is True
    assert [fold["kind"] for fold in answer["folds"]] == ["blue", "red"]


def test_check_of_a_fold_that_two_grippers_cannot_hold_is_status_3_and_says_what_would_do(tmp_path: Path) -> None:
    # A hand for each eave and one for the tip, unless one amid a slope, half of hypot(0.2, 0.1) long, holds two.
    house = {
        "name": "house",
        "outline": [[0.4, 0.3], [0.0, 0.3], [0.0, -0.1], [0.2, -0.2], [0.4, -0.1]],
        "folds": [{"name": "roof", "kind": "blue", "start": [0.4, 0.0], "end": [0.0, 0.0], "grip_radius_m": 0.08}],
    }
    path = saved(tmp_path, house)
    result = pleat("check", path)
    assert result.exit_code == 3
    assert "towel.json: folds[0]: the grippers cannot hold it" in result.stderr
    assert "3 points of its edge must be held" in result.stderr
    assert "a grip radius of 0.112 m would do" in result.stderr
    assert json.loads(pleat("check", path, "--json", "-").stdout)["is_holdable"] is False


def test_a_token_that_is_too_short_is_refused_before_anything_is_served(tmp_path: Path) -> None:
    short = tmp_path / "token"
    short.write_text("secret\n")
    result = pleat("serve", "--token-file", str(short), "--port", "0", "--data", str(tmp_path / "data"))
    assert result.exit_code == 2
    assert str(short) in result.stderr and "at least 20 characters" in result.stderr


@pytest.mark.parametrize("inside", ["", "deeper", "robots"])
def test_a_data_path_that_is_none_is_said_before_any_address(tmp_path: Path, inside: str) -> None:
    data = tmp_path / "data"
    if inside == "robots":
        data.mkdir()
        (data / inside).write_text("a file")
    else:
        data.write_text("a file")
        data /= inside
    result = pleat("serve", "--port", "0", "--data", str(data))
    assert result.exit_code == 2
    assert result.stdout == ""
    assert str(data) in result.stderr.replace("\n", "")


def test_what_is_listed_of_a_command_is_the_first_sentence_of_its_help() -> None:
    for name, listed in COMMANDS.items():
        assert str(loaded(name).help).partition("\n\n")[0].replace("\n", " ") == listed.does
    assert set(COMMANDS) == set(get_group(cli).commands)


def test_commands_are_listed_without_the_planner() -> None:
    heavy = {"numpy", "planner.cloth", "sqlalchemy", "viser"}
    script = f"import sys; import app.cli; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_garbage_collector_rests_while_the_program_is_imported_and_looks_at_what_comes_later() -> None:
    script = """
import gc
begun = []
gc.callbacks.append(lambda phase, told: begun.append(told) if phase == "start" else None)
from app.cli.commands import loaded
begun.clear()
loaded("study")
print(len(begun) < 3, gc.isenabled(), gc.get_freeze_count() > 100_000)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "True", "True"]  # one may be due before it begins
