"""The user's cache keeps what was used lately."""

import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from app.cli import cache as cache_command
from app.cli import cli
from planner.user_cache import CACHES, Cache, use


@pytest.fixture
def kept(tmp_path: Path) -> list[Path]:
    """Return a folder with a file, two files and another folder with a file, used one after the other."""
    (tmp_path / "links").mkdir()
    found = [tmp_path / "links" / name for name in ("folder", "one.npz", "two.npz", "newest")]
    for path in found:
        if path.suffix:
            path.write_text("map")
        else:
            path.mkdir()
            (path / "kernel").write_text("code")
    for age_s, path in enumerate(reversed(found)):
        os.utime(path, (1000 - age_s, 1000 - age_s))
    return found


def limit(monkeypatch: pytest.MonkeyPatch, kept_max: int) -> None:
    monkeypatch.setitem(CACHES, "links", Cache("links", kept_max))


def test_what_was_used_least_lately_goes_be_it_a_folder(kept: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    limit(monkeypatch, 3)
    use(kept[3])
    assert [path.exists() for path in kept] == [False, True, True, True]
    limit(monkeypatch, 1)
    use(kept[3])
    assert [path.exists() for path in kept] == [False, False, False, True]
    assert (kept[3] / "kernel").exists()


def test_what_is_used_again_stays(kept: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    limit(monkeypatch, 2)
    use(kept[0])
    assert [path.exists() for path in kept] == [True, False, False, True]


def test_what_is_not_there_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        use(tmp_path / "links" / "none")


def test_the_command_lists_what_is_kept_and_removes_it(kept: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache_command, "cache_folder", lambda: kept[0].parents[1])

    listed = CliRunner().invoke(cli, ["cache"], env={"COLUMNS": "120"})
    assert "links" in listed.output and "4" in listed.output
    cleared = CliRunner().invoke(cli, ["cache", "--clear"])
    assert cleared.exit_code == 0 and "removed" in cleared.output
    assert not kept[0].parents[1].exists()
