"""Keep arrays in the user's cache: in files that exist only once they are complete."""

import os
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from planner.user_cache import use

T = TypeVar("T")

Arrays = Mapping[str, NDArray[Any]]
"""Arrays by name, as a file holds them."""


def kept(path: Path, read: Callable[[Arrays], T], make: Callable[[], T], written: Callable[[T], Arrays]) -> T:
    """Return what a file in a cache holds, or make it and keep it.

    A file that cannot be read is made again; one that cannot be written is ignored.

    Args:
        path: the file.
        read: makes the value of the file's arrays; may raise `ValueError` or `KeyError`.
        make: makes the value anew.
        written: returns the arrays of the value.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            found = read(arrays)
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        found = make()
        with suppress(OSError):
            _write(path, written(found))
    with suppress(OSError):
        use(path)
    return found


def _write(path: Path, arrays: Arrays) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".npz")
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
