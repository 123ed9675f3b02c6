"""The user's cache: what is made once for later runs, in which only what was used lately stays."""

import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from platformdirs import user_cache_path


@dataclass(frozen=True, slots=True)
class Cache:
    """A folder of the user's cache.

    Attributes:
        holds: what is in it.
        kept_max: how many files or folders stay in it.
    """

    holds: str
    kept_max: int


CACHES: Final[dict[str, Cache]] = {
    # Each is for a state of the sources: a checkout or two, and the state before an update.
    "kernels": Cache("compiled kernels", 4),
    "links": Cache("robots as a camera sees them", 32),
    "postures": Cache("reach maps, one an arm", 64),
    "shapes": Cache("collision shapes, one a robot", 64),
    "urdf": Cache("URDFs composed of arms and grippers", 64),
}
"""The folders of the cache by name."""


def cache_folder() -> Path:
    """Return the user's cache."""
    return user_cache_path("pleat")


def use(kept: Path) -> None:
    """Note that a file or a folder in one of the caches is used, and drop the least lately used beyond the limit.

    Raises:
        OSError: the cache cannot be read or written.
    """
    os.utime(kept)
    ages = {one: one.stat().st_mtime for one in kept.parent.iterdir()}
    for old in sorted(ages, key=ages.__getitem__, reverse=True)[CACHES[kept.parent.name].kept_max :]:
        if old.is_dir():
            shutil.rmtree(old, ignore_errors=True)
        else:
            old.unlink(missing_ok=True)
