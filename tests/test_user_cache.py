"""The user's cache keeps what was used lately."""

import os
from pathlib import Path

import pytest

from planner.user_cache import use


@pytest.fixture
def kept(tmp_path: Path) -> list[Path]:
    """Return a folder with a file, two files and another folder with a file, used one after the other."""
    found = [tmp_path / name for name in ("folder", "one.npz", "two.npz", "newest")]
    for path in found:
        if path.suffix:
            path.write_text("map")
        else:
            path.mkdir()
            (path / "kernel").write_text("code")
    for age_s, path in enumerate(reversed(found)):
        os.utime(path, (1000 - age_s, 1000 - age_s))
    return found


def test_what_was_used_least_lately_goes_be_it_a_folder(kept: list[Path]) -> None:
    use(kept[3], 3)
    assert [path.exists() for path in kept] == [False, True, True, True]
    use(kept[3], 1)
    assert [path.exists() for path in kept] == [False, False, False, True]
    assert (kept[3] / "kernel").exists()


def test_what_is_used_again_stays(kept: list[Path]) -> None:
    use(kept[0], 2)
    assert [path.exists() for path in kept] == [True, False, False, True]


def test_what_is_not_there_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        use(tmp_path / "none", 1)
