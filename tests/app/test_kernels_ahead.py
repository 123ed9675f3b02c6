"""The kernels that the cache lacks are compiled behind a server that answers already."""

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from app import workspace as workspaces
from app.live_planning import compile_for
from app.settings import Settings
from app.worker.stop import Stop
from app.workspace import Workspace


@pytest.fixture
def workspace(tmp_path: Path) -> Iterator[Workspace]:
    made = Workspace(Settings(data=tmp_path), {})
    made.prepare()
    yield made
    made.close()


def test_the_missing_kinds_of_kernels_are_compiled_in_the_background(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[Any, ...]] = []
    done = threading.Event()

    def run(work: object, stop: Stop, on_news: object, *arguments: object) -> None:
        asked.append((work, *arguments))
        done.set()

    monkeypatch.setattr(workspaces, "must_compile", lambda robot: True)
    monkeypatch.setattr(workspace.lanes.background, "run", run)
    workspace.start()
    assert done.wait(30.0)
    assert asked == [(compile_for, "so101-pair")]


def test_nothing_is_compiled_where_the_cache_has_all(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[str] = []
    done = threading.Event()

    def must_compile(robot: str) -> bool:
        looked.append(robot)
        done.set()
        return False

    monkeypatch.setattr(workspaces, "must_compile", must_compile)
    monkeypatch.setattr(workspace.lanes.background, "run", lambda *_: pytest.fail("compiled once more"))
    workspace.start()
    assert done.wait(30.0)
    assert looked == ["so101-pair"]
