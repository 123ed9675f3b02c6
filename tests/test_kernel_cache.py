"""Compiled kernels are cached for one state of all their sources, so that no outdated one is used."""

import os
from pathlib import Path

import pytest

from planner import kernel_cache

KERNEL = "from planner.kernels import kernel\n\nfrom planner.units import STEP\n"


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for room in ("robots", "primitives"):
        (tmp_path / "planner" / room).mkdir(parents=True)
        (tmp_path / "planner" / room / "kernel.py").write_text(KERNEL)
        (tmp_path / "planner" / room / "other.py").write_text("one = 1\n")
    (tmp_path / "planner" / "units.py").write_text("STEP = 1\n")
    monkeypatch.setattr(kernel_cache, "__file__", str(tmp_path / "planner" / "kernel_cache.py"))
    monkeypatch.setattr(kernel_cache, "cache_folder", lambda: tmp_path / "cache" / "pleat")
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    return tmp_path / "planner"


def used(monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    kernel_cache.use_kernel_cache()
    return Path(os.environ["NUMBA_CACHE_DIR"])


def test_the_folder_is_another_once_any_kernel_is(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = used(monkeypatch)
    assert before.is_dir() and used(monkeypatch) == before
    (package / "primitives" / "kernel.py").write_text(f"{KERNEL}one = 2\n")
    assert used(monkeypatch) != before


def test_the_folder_is_another_once_a_constant_of_kernels_is(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = used(monkeypatch)
    (package / "units.py").write_text("STEP = 2\n")
    assert used(monkeypatch) != before


def test_the_folder_stays_while_only_others_change(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = used(monkeypatch)
    (package / "primitives" / "other.py").write_text("one = 2\n")
    assert used(monkeypatch) == before


def test_old_folders_go(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folders = []
    for number in range(6):
        (package / "robots" / "kernel.py").write_text(f"{KERNEL}one = {number}\n")
        folders.append(used(monkeypatch))
        os.utime(folders[-1], (number, number))
    last = used(monkeypatch)
    assert last == folders[-1] and len(list(last.parent.iterdir())) == 4
    assert not folders[0].exists()


def test_who_says_where_is_obeyed(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", "/elsewhere")
    kernel_cache.use_kernel_cache()
    assert os.environ["NUMBA_CACHE_DIR"] == "/elsewhere"


def test_without_a_place_to_keep_them_numba_looks_for_one(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (package.parent / "cache").write_text("a file where a folder should be")
    kernel_cache.use_kernel_cache()
    assert "NUMBA_CACHE_DIR" not in os.environ


def test_kernels_are_to_be_compiled_until_all_of_a_kind_are_in_the_folder_in_use(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    used(monkeypatch)
    assert not kernel_cache.are_kernels_kept("mapped")
    kernel_cache.note_kernels_kept("mapped")
    assert kernel_cache.are_kernels_kept("mapped") and not kernel_cache.are_kernels_kept("closed-form")
    (package / "units.py").write_text("STEP = 3\n")
    used(monkeypatch)
    assert not kernel_cache.are_kernels_kept("mapped")


def test_where_nothing_is_kept_kernels_are_compiled_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    kernel_cache.note_kernels_kept("mapped")
    assert not kernel_cache.are_kernels_kept("mapped")
