import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from app.cli import cli
from planner import load_garment


def propose(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ("propose", *arguments))


def test_proposals_are_printed_as_a_table() -> None:
    result = propose("hand-towel", "--to", "shelf", "--anew", "--count", "1")
    assert result.exit_code == 0
    for heading in ("folds", "size", "layers", "face", "seconds", "status", "solved", "0.229 x 0.209"):
        assert heading in result.stdout


def test_json_comes_alone_with_folds_and_how_many_were_enumerated() -> None:
    result = propose("hand-towel", "--to", "0.25x0.30", "--anew", "--count", "2", "--json", "-")
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert [one["status"] for one in answer["proposals"]] == ["solved", "solved"]
    assert answer["enumerated"] > 2


def test_folds_that_the_garment_has_are_kept() -> None:
    result = propose("hand-towel", "--to", "25x30cm", "--count", "1", "--json", "-")
    assert result.exit_code == 0
    (only,) = json.loads(result.stdout)["proposals"]
    assert only["folds"] == load_garment("hand-towel").to_dict()["folds"]


def test_the_folds_of_another_garment_are_fitted(tmp_path: Path) -> None:
    towel = tmp_path / "towel.json"
    towel.write_text(json.dumps({**load_garment("hand-towel").to_dict(), "folds": [], "grip_radius_m": 0.2}))
    result = propose(str(towel), "--like", "hand-towel", "--json", "-")
    assert result.exit_code == 0
    (only,) = json.loads(result.stdout)["proposals"]
    assert [fold["name"] for fold in only["folds"]] == [fold.name for fold in load_garment("hand-towel").folds]
    assert propose("tie", "--like", str(towel)).stderr == "--like: 'Hand towel' has no folds\n"
    for both_or_none in ((), ("--like", "tie", "--to", "shelf")):
        refused = propose("tie", *both_or_none)
        assert refused.exit_code == 2
        assert "--like GARMENT" in refused.stderr


def test_where_nothing_fits_the_status_is_3_and_the_size_is_named() -> None:
    result = propose("hand-towel", "--to", "1x1cm", "--max-folds", "3")
    assert result.exit_code == 3
    assert "--to" in result.stderr
    assert "1x1cm" in result.stderr
    assert re.search(r"smallest found is \d+ x \d+ cm", " ".join(result.stderr.split()))


def test_where_the_robot_can_do_none_the_status_is_3(tmp_path: Path) -> None:
    far = {**load_garment("hand-towel").to_dict(), "folds": [], "placement": {"x_m": 8.0, "y_m": 8.0, "yaw_rad": 0.0}}
    path = tmp_path / "far.json"
    path.write_text(json.dumps(far))
    result = propose(str(path), "--to", "shelf", "--count", "1")
    assert result.exit_code == 3
    assert "none of them" in result.stderr
    assert "infeasible: " in result.stdout


@pytest.mark.parametrize(
    ("option", "value"),
    [("--to", "attic"), ("--count", "0"), ("--max-folds", "65"), ("--face", "left"), ("--robot", "nobody")],
)
def test_a_bad_value_is_status_2_with_option_and_value(option: str, value: str) -> None:
    to = () if option == "--to" else ("--to", "shelf")
    result = propose("hand-towel", *to, option, value)
    assert result.exit_code == 2
    assert value in result.stderr
    assert option in result.stderr or option == "--robot"
