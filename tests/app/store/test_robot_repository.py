"""Robots on the disk and in the database: interrupted changes, other servers, folders of versions before."""

import io
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from zipfile import ZipFile

import pytest
from sqlalchemy import text

from app.store.database import Database
from app.store.robot_repository import RobotRepository
from app.store.storage_error import StorageError
from planner.errors import UnknownRobotError
from tests.databases import emptied


def unpacked(folder: Path, content: str) -> Path:
    folder.mkdir(parents=True)
    (folder / "robot.json").write_text(content)
    return folder


def files(folder: Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): path.read_text() for path in folder.rglob("*") if path.is_file()}


def packed_files(contents: dict[str, str]) -> bytes:
    target = io.BytesIO()
    with ZipFile(target, "w") as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return target.getvalue()


@pytest.fixture
def own(tmp_path: Path) -> Iterator[Database]:
    with closing(Database(tmp_path / "pleat.db")) as database:
        yield database


def test_a_robot_whose_replacement_was_interrupted_is_as_before(tmp_path: Path, own: Database) -> None:
    robots = tmp_path / "robots"
    unpacked(robots / ".before-bench", "old")
    unpacked(robots / ".new-abc", "new")
    RobotRepository(robots, own).recover()
    assert (robots / "bench" / "robot.json").read_text() == "old"
    assert [path.name for path in robots.iterdir()] == ["bench"]


def test_what_is_left_of_a_robot_that_was_replaced_or_removed_goes(tmp_path: Path, own: Database) -> None:
    robots = tmp_path / "robots"
    unpacked(robots / "bench", "new")
    unpacked(robots / ".before-bench", "old")
    (robots / ".before-gone").mkdir()
    RobotRepository(robots, own).recover()
    assert (robots / "bench" / "robot.json").read_text() == "new"
    assert [path.name for path in robots.iterdir()] == ["bench"]


@pytest.mark.parametrize("name", ["", ".", "..", "../x", ".before-x", "a/b"])
def test_nothing_but_a_robot_is_removed(tmp_path: Path, own: Database, name: str) -> None:
    unpacked(tmp_path / "robots" / ".before-x", "kept")
    unpacked(tmp_path / "robots" / "a" / "b", "kept")
    unpacked(tmp_path / "x", "kept")
    with pytest.raises(UnknownRobotError):
        RobotRepository(tmp_path / "robots", own).remove(name)
    assert len(list(tmp_path.rglob("robot.json"))) == 3


def test_robots_of_versions_that_kept_folders_alone_are_taken_over(tmp_path: Path, own: Database) -> None:
    (unpacked(tmp_path / "robots" / "bench", "card") / "meshes").mkdir()
    (tmp_path / "robots" / "bench" / "meshes" / "arm.stl").write_text("mesh")
    RobotRepository(tmp_path / "robots", own).take_over()
    assert files(tmp_path / "robots" / "bench") == {"robot.json": "card", "meshes/arm.stl": "mesh"}
    RobotRepository(tmp_path / "elsewhere", own).take_over()
    assert files(tmp_path / "elsewhere" / "bench") == {"robot.json": "card", "meshes/arm.stl": "mesh"}


def test_a_folder_changed_by_hand_is_taken_over_where_no_other_server_is(tmp_path: Path, own: Database) -> None:
    unpacked(tmp_path / "robots" / "bench", "first")
    RobotRepository(tmp_path / "robots", own).take_over()
    (tmp_path / "robots" / "bench" / "robot.json").write_text("second")
    RobotRepository(tmp_path / "robots", own).take_over()
    assert files(tmp_path / "robots" / "bench") == {"robot.json": "second"}
    RobotRepository(tmp_path / "elsewhere", own).take_over()
    assert files(tmp_path / "elsewhere" / "bench") == {"robot.json": "second"}


def test_a_robot_that_the_database_refuses_is_as_before(
    tmp_path: Path, own: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    robots = RobotRepository(tmp_path / "robots", own)
    assert robots.take("bench", unpacked(tmp_path / "robots" / ".new-1", "first")) is True

    def refuse(*_: object, **__: object) -> None:
        raise StorageError("it could not be saved", "no room")

    with monkeypatch.context() as patched, pytest.raises(StorageError, match="no room"):
        patched.setattr(own, "writing", refuse)
        robots.take("bench", unpacked(tmp_path / "robots" / ".new-2", "second"))
    assert files(tmp_path / "robots") == {"bench/robot.json": "first"}
    assert robots.take("bench", unpacked(tmp_path / "robots" / ".new-3", "third")) is False
    assert files(tmp_path / "robots") == {"bench/robot.json": "third"}


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("bad", b"no zip"),
        ("bad", packed_files({"robot.json": "card", "arm.stl": "mesh"})[:-40]),
        ("bad", packed_files({"arm.stl": "mesh"})),
        ("bad", packed_files({"robot.json": "card", "robot.json/arm.stl": "mesh"})),
        ("bad", "a text"),
        ("", packed_files({"robot.json": "card"})),
        ("../bad", packed_files({"robot.json": "card"})),
        (".before-good", packed_files({"robot.json": "card"})),
    ],
)
def test_a_bad_row_hides_no_other_robot_and_is_logged_once(
    tmp_path: Path, own: Database, caplog: pytest.LogCaptureFixture, name: str, content: bytes | str
) -> None:
    unpacked(tmp_path / "first" / "good", "card")
    RobotRepository(tmp_path / "first", own).take_over()
    with own.writing("the row could not be written") as session:
        values = {"name": name, "content": content}
        session.execute(text("INSERT INTO robots VALUES (:name, 'x', :content)"), values)
    robots = RobotRepository(tmp_path / "robots", own)
    robots.take_over()
    robots.refresh()
    assert files(tmp_path / "robots") == {"good/robot.json": "card"}
    assert not (tmp_path / "bad").exists()
    errors = [record.getMessage() for record in caplog.records if record.levelname == "ERROR"]
    assert len(errors) == 1 and repr(name) in errors[0]


def test_servers_on_one_database_have_each_others_robots(tmp_path: Path, postgresql_server: str) -> None:
    url = emptied(postgresql_server)
    with closing(Database(tmp_path / "a.db", url)) as one, closing(Database(tmp_path / "b.db", url)) as other:
        first, second = RobotRepository(tmp_path / "a", one), RobotRepository(tmp_path / "b", other)
        for robots in (first, second):
            robots.take_over()
        first.take("bench", unpacked(tmp_path / "a" / ".new-1", "first"))
        second.refresh()
        assert files(tmp_path / "b") == {"bench/robot.json": "first"}
        second.take("bench", unpacked(tmp_path / "b" / ".new-1", "second"))
        first.refresh()
        assert files(tmp_path / "a") == {"bench/robot.json": "second"}
        first.remove("bench")
        second.refresh()
        assert files(tmp_path / "b") == {}
        # One that was away while its robot was removed does not bring it back.
        unpacked(tmp_path / "c" / "bench", "second")
        RobotRepository(tmp_path / "c", other).take_over()
        assert files(tmp_path / "c") == {}
