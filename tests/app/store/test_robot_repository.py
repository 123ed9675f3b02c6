"""Robots on the disk: what is left when a server ends in the middle of a change."""

from pathlib import Path

import pytest

from app.store.robot_repository import RobotRepository
from planner.errors import UnknownRobotError


def unpacked(folder: Path, content: str) -> Path:
    folder.mkdir(parents=True)
    (folder / "robot.json").write_text(content)
    return folder


def test_a_robot_whose_replacement_was_interrupted_is_as_before(tmp_path: Path) -> None:
    unpacked(tmp_path / ".before-bench", "old")
    unpacked(tmp_path / ".new-abc", "new")
    RobotRepository(tmp_path).recover()
    assert (tmp_path / "bench" / "robot.json").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["bench"]


def test_what_is_left_of_a_robot_that_was_replaced_or_removed_goes(tmp_path: Path) -> None:
    unpacked(tmp_path / "bench", "new")
    unpacked(tmp_path / ".before-bench", "old")
    (tmp_path / ".before-gone").mkdir()
    RobotRepository(tmp_path).recover()
    assert (tmp_path / "bench" / "robot.json").read_text() == "new"
    assert [path.name for path in tmp_path.iterdir()] == ["bench"]


@pytest.mark.parametrize("name", ["", ".", "..", "../x", ".before-x", "a/b"])
def test_nothing_but_a_robot_is_removed(tmp_path: Path, name: str) -> None:
    unpacked(tmp_path / "robots" / ".before-x", "kept")
    unpacked(tmp_path / "robots" / "a" / "b", "kept")
    unpacked(tmp_path / "x", "kept")
    with pytest.raises(UnknownRobotError):
        RobotRepository(tmp_path / "robots").remove(name)
    assert len(list(tmp_path.rglob("robot.json"))) == 3
