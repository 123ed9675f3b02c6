import stat
from pathlib import Path

import pytest

from app.store.access_token import WeakTokenError, file_token, kept_token
from app.store.storage_error import StorageError


def test_a_token_is_made_once_and_only_its_hash_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "token.json"
    token, made = kept_token(path)
    assert made is not None and len(made) >= 40
    assert token.matches(made) and not token.matches(made[:-1]) and not token.matches("")
    assert made not in path.read_text()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert kept_token(path) == (token, None)


def test_a_new_token_replaces_the_old_one_and_so_does_a_file_that_is_broken(tmp_path: Path) -> None:
    path = tmp_path / "token.json"
    old, _ = kept_token(path)
    new, made = kept_token(path, is_new=True)
    assert made is not None and new.matches(made) and not old.matches(made)
    path.write_text("{}")
    assert kept_token(path)[1] is not None


def test_a_token_of_a_file_is_made_for_its_owner_alone_and_then_read(tmp_path: Path) -> None:
    path = tmp_path / "token"
    token = file_token(path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert token.matches(path.read_text().strip())
    assert file_token(path) == token
    path.write_text("short\n")
    with pytest.raises(WeakTokenError):
        file_token(path)
    with pytest.raises(StorageError):
        file_token(tmp_path / "nowhere" / "token")
