"""The cache of compiled kernels: a folder in the user's cache for each state of their sources.

Numba caches compiled code by source file and looks at the age of that file alone. But a kernel may call kernels from
other files, and when one of these changes, the cached code is out of date. The folder's name is therefore a digest of
all their sources.
"""

import hashlib
import os
import re
from contextlib import suppress
from pathlib import Path

from planner.user_cache import cache_folder, use

_IS_KERNEL = re.compile(r"^from planner.kernels import", re.MULTILINE)
"""The mark of a module that has kernels."""

_IMPORTED = re.compile(r"^from (planner[\w.]*) import", re.MULTILINE)
"""The modules of ours that a module imports: a kernel calls their kernels, and their constants are part of it."""


def use_kernel_cache() -> None:
    """Have Numba keep kernels in the folder for these sources, unless `NUMBA_CACHE_DIR` says where; call it first."""
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    folder = cache_folder() / "kernels" / _digest(Path(__file__).parent)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        use(folder)
    except OSError:
        return  # nowhere to keep them: Numba finds a place of its own, or compiles each time
    os.environ["NUMBA_CACHE_DIR"] = str(folder)


def are_kernels_kept(kind: str) -> bool:
    """Return whether all kernels of a kind have been compiled into the cache in use."""
    folder = os.environ.get("NUMBA_CACHE_DIR")
    return folder is not None and (Path(folder) / _mark(kind)).exists()


def note_kernels_kept(kind: str) -> None:
    """Note in the cache in use that all kernels of a kind have been compiled into it."""
    folder = os.environ.get("NUMBA_CACHE_DIR")
    if folder is not None:
        with suppress(OSError):  # one that cannot be written keeps no kernels either
            (Path(folder) / _mark(kind)).touch()


def _mark(kind: str) -> str:
    return f"compiled-{kind}"


def _digest(package: Path) -> str:
    """Return a name for the state of the sources of all kernels, and of where they are: Numba keeps paths too."""
    texts = {path: path.read_text() for path in package.rglob("*.py")}
    sources = {path for path, text in texts.items() if _IS_KERNEL.search(text)}
    for path in tuple(sources):
        sources |= {
            (package.parent / name.replace(".", "/")).with_suffix(".py") for name in _IMPORTED.findall(texts[path])
        }
    found = hashlib.sha256(str(package).encode())
    for path in sorted(sources & texts.keys()):
        found.update(texts[path].encode())
    return found.hexdigest()[:16]
