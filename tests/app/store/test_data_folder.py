"""A data folder is locked by the server that uses it; a second server is told which one that is."""

import json
import os
from pathlib import Path

import pytest

from app.store.data_folder import DataFolder, HeldFolderError, UnusableFolderError
from tests.app.refused import refused


def test_a_folder_is_made_and_held_by_one_at_a_time(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "data"
    with DataFolder(path).held() as announce:
        announce("http://127.0.0.1:8123")
        with pytest.raises(HeldFolderError) as told, DataFolder(path).held():
            pass
    text = str(told.value)
    assert f"process {os.getpid()} " in text
    assert "http://127.0.0.1:8123" in text
    assert str(path) in text
    with DataFolder(path).held():
        pass


def test_who_holds_a_folder_need_not_have_said_so(tmp_path: Path) -> None:
    with DataFolder(tmp_path).held():
        for content in ("", "{", json.dumps({"pid": 1}), "[]"):
            (tmp_path / "server.json").write_text(content)
            with pytest.raises(HeldFolderError, match="in use by another server"), DataFolder(tmp_path).held():
                pass


def test_what_a_dead_server_has_left_holds_nobody_up(tmp_path: Path) -> None:
    (tmp_path / "server.lock").write_text("")
    (tmp_path / "server.json").write_text('{"pid": 1, "host": "here", "since": "then", "url": null}')
    with DataFolder(tmp_path).held():
        assert json.loads((tmp_path / "server.json").read_text())["pid"] == os.getpid()
    assert not (tmp_path / "server.json").exists()


@pytest.mark.parametrize("inside", ["", "deeper", "robots"])
def test_a_file_in_the_place_of_a_folder_is_named(tmp_path: Path, inside: str) -> None:
    path = tmp_path / "data"
    if inside == "robots":
        path.mkdir()
        (path / inside).write_text("a file")
    else:
        path.write_text("a file")
        path /= inside
    with pytest.raises(UnusableFolderError, match=str(path)), DataFolder(path).held():
        pass


@pytest.mark.parametrize("number", ["EACCES", "EROFS", "EPERM"])
def test_a_read_only_folder_can_be_looked_at_without_a_lock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: str
) -> None:
    with refused(monkeypatch, tmp_path, number), DataFolder(tmp_path).held() as announce:
        announce("http://127.0.0.1:8123")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_can_be_written_but_not_locked_is_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (
        refused(monkeypatch, tmp_path, "EIO"),
        pytest.raises(UnusableFolderError, match="locked"),
        DataFolder(tmp_path).held(),
    ):
        pass


@pytest.mark.parametrize("number", ["EACCES", "EROFS", "ENOSPC", "EDQUOT", "EIO"])
@pytest.mark.parametrize("folder", [".", "robots"])
def test_what_is_wrong_with_a_folder_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: str, folder: str
) -> None:
    data = DataFolder(tmp_path)
    assert data.problem() is None
    (tmp_path / folder).mkdir(exist_ok=True)
    assert data.problem() is None
    with refused(monkeypatch, tmp_path / folder, number):
        problem = data.problem()
    assert problem is not None and "cannot be written" in problem
    assert str(tmp_path) not in problem, "no path is told to others"
    assert [path.name for path in tmp_path.iterdir()] == ([] if folder == "." else [folder])


def test_a_folder_that_has_gone_is_told(tmp_path: Path) -> None:
    assert DataFolder(tmp_path / "none").problem() is not None
