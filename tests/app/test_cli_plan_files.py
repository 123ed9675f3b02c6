"""Plan files on the command line: written, shown, sampled, continued, exported."""

import json
import zipfile
from itertools import pairwise
from pathlib import Path

import pytest

from app.files.export import no_plan
from app.files.exports import EXPORTS
from planner import Plan
from planner.task.plan_files import read_plan
from tests.app.samples import towel
from tests.app.test_cli import pleat
from tests.required import required
from tests.small_plan import unsolved


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("plans") / "towel.plan.json"
    assert pleat("plan", "letter-towel", "--out", str(path)).exit_code == 0
    return path


def test_a_plan_file_is_shown_as_it_was_planned(file: Path) -> None:
    shown = pleat("show", str(file))
    assert shown.exit_code == 0
    assert shown.stdout == pleat("plan", "letter-towel").stdout


@pytest.fixture(scope="module")
def refused_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the plan file of a garment that lies out of reach."""
    folder = tmp_path_factory.mktemp("refused")
    garment, path = folder / "far.json", folder / "no.plan.json"
    garment.write_text(json.dumps(towel(placement={"x_m": 3.0, "y_m": 0.0, "yaw_rad": 0.0})))
    assert pleat("plan", str(garment), "--out", str(path)).exit_code == 3
    return path


def test_a_plan_file_without_a_plan_says_why(refused_file: Path) -> None:
    shown = pleat("show", str(refused_file))
    assert shown.exit_code == 3 and shown.stderr
    timeline = pleat("timeline", str(refused_file))
    assert timeline.exit_code == 2 and "infeasible" in timeline.stderr


def test_the_reasons_of_a_plan_file_are_told_from_their_numbers(refused_file: Path, tmp_path: Path) -> None:
    spoilt = tmp_path / "spoilt.plan.json"
    data = json.loads(refused_file.read_text(encoding="utf-8"))
    assert data["reasons"]
    for reason in data["reasons"]:
        reason["message"] = "RUBBISH"
    spoilt.write_text(json.dumps(data), encoding="utf-8")
    assert pleat("show", str(spoilt)).stderr == pleat("show", str(refused_file)).stderr != ""


def test_the_timeline_is_that_of_rest(file: Path) -> None:
    told = json.loads(pleat("timeline", str(file), "--rate-hz", "50", "--json", "-").stdout)
    assert told["rate_hz"] == 50
    times = [sample["t_s"] for sample in told["samples"]]
    assert times == sorted(set(times)) and times[-1] == read_plan(file).cost_s
    assert set(told["samples"][0]["velocities"]) == set(told["samples"][0]["joints"])


def test_velocities_are_how_joints_change(file: Path) -> None:
    samples = json.loads(pleat("timeline", str(file), "--rate-hz", "100").stdout)["samples"]
    off = []
    for before, after in pairwise(samples):
        step_s = after["t_s"] - before["t_s"]
        for name, speed in before["velocities"].items():
            off.append(abs((after["joints"][name] - before["joints"][name]) / step_s - speed))
    assert sorted(off)[int(0.95 * len(off))] < 0.05, "but for the moments at which a joint changes its speed"


def test_planning_goes_on_from_a_plan(file: Path, tmp_path: Path) -> None:
    rest = tmp_path / "rest.plan.json"
    assert pleat("plan", "letter-towel", "--from", str(file), "--after-step", "0", "--out", str(rest)).exit_code == 0
    whole, tail = read_plan(file), read_plan(rest)
    assert tail.cost_s == pytest.approx(required(whole.cost_s) - whole.steps[0].end_s)
    assert tail.task.start == whole.steps[0].after


def test_a_plan_file_is_taken_where_a_garment_is(file: Path) -> None:
    assert pleat("check", str(file)).exit_code == 0
    assert pleat("dag", str(file)).exit_code == 0
    again = json.loads(pleat("plan", str(file), "--json", "-").stdout)
    assert again["cost_s"] == read_plan(file).cost_s


@pytest.mark.parametrize(
    "kind",
    ["garment.json", "garment.svg", "garment.fold", "plan.json", "plan.csv", "mcap", "poses-yaml", "glb", "sheet-svg"],
)
def test_a_plan_file_is_exported(file: Path, tmp_path: Path, kind: str) -> None:
    target = tmp_path / "out"
    assert pleat("export", str(file), "--to", kind, "--out", str(target)).exit_code == 0
    data = target.read_bytes()
    assert data
    if kind == "plan.json":
        assert Plan.from_dict(json.loads(data)) == read_plan(file)


def test_an_export_is_slowed_to_a_share_of_the_planned_speed(file: Path, tmp_path: Path) -> None:
    target = tmp_path / "slow.plan.json"
    assert pleat("export", str(file), "--to", "plan.json", "--speed", "0.25", "--out", str(target)).exit_code == 0
    planned_s = read_plan(file).cost_s
    assert planned_s is not None
    assert read_plan(target).cost_s == pytest.approx(4.0 * planned_s)
    poses = tmp_path / "poses.json"
    assert pleat("export", str(file), "--to", "poses.json", "--speed", "0.25", "--out", str(poses)).exit_code == 0
    assert max(grip["grasp"]["t_s"] for s in json.loads(poses.read_text())["steps"] for grip in s["grips"]) > planned_s


def test_a_folder_is_exported_as_one_or_zipped(file: Path, tmp_path: Path) -> None:
    folder, archive = tmp_path / "new" / "bag", tmp_path / "bag.zip"
    for target in (folder, archive):
        assert pleat("export", str(file), "--to", "rosbag2", "--out", str(target)).exit_code == 0
    assert sorted(path.name for path in folder.iterdir()) == ["metadata.yaml", "motion.db3"]
    assert sorted(zipfile.ZipFile(archive).namelist()) == ["metadata.yaml", "motion.db3"]
    again = pleat("export", str(file), "--to", "rosbag2", "--out", str(folder))
    assert again.exit_code == 2 and str(folder) in again.stderr


@pytest.mark.parametrize("kind", [export.what for export in EXPORTS if export.why_not is no_plan])
def test_what_needs_a_plan_is_refused_without_one(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "no.plan.json"
    path.write_text(json.dumps(unsolved().to_dict()))
    result = pleat("export", str(path), "--to", kind, "--out", str(tmp_path / "out"))
    assert result.exit_code == 2 and "no plan" in result.stderr
    assert not (tmp_path / "out").exists()


def test_kinds_of_exports_are_listed() -> None:
    listed = pleat("export", "--list")
    assert listed.exit_code == 0
    assert all(export.what in listed.stdout for export in EXPORTS)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("show", "nowhere.plan.json"), "nowhere.plan.json"),
        (("plan", "vest", "--after-step", "0"), "--after-step"),
        (("plan", "letter-towel", "--from", "FILE", "--after-step", "9"), "--after-step: 9"),
        (("plan", "vest", "--out", "/nowhere/vest.plan.json"), "/nowhere/vest.plan.json"),
        (("timeline", "FILE", "--rate-hz", "0"), "--rate-hz"),
        (("export", "FILE", "--to", "gcode"), "--to"),
        (("export", "FILE"), "--to"),
        (("export", "FILE", "--to", "mcap", "--speed", "0.04"), "--speed: expected 0.05 to 1, got 0.04"),
        (("export", "FILE", "--to", "garment.svg", "--speed", "1.5"), "--speed: expected 0.05 to 1, got 1.5"),
        (("export", "FILE", "--to", "mcap", "--speed", "nan"), "--speed"),
        (("export", "FILE", "--to", "mcap", "--out", "/nowhere/towel.mcap"), "/nowhere/towel.mcap"),
        (("export", "FILE", "--to", "rosbag2", "--out", "/proc/bag"), "/proc/bag"),
    ],
)
def test_bad_usage_is_told_with_status_2(file: Path, arguments: tuple[str, ...], told: str) -> None:
    result = pleat(*(str(file) if word == "FILE" else word for word in arguments))
    assert result.exit_code == 2
    assert told in result.stderr


def test_a_file_that_is_no_plan_is_told_by_field(file: Path, tmp_path: Path) -> None:
    spoilt = json.loads(file.read_text())
    spoilt["steps"][1]["start_s"] = "soon"
    path = tmp_path / "spoilt.plan.json"
    path.write_text(json.dumps(spoilt))
    result = pleat("show", str(path))
    assert result.exit_code == 2 and "[1].start_s" in result.stderr and path.name in result.stderr
