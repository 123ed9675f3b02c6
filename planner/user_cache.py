"""The user's cache, in which only what was used lately stays."""

import os
import shutil
from pathlib import Path


def use(kept: Path, kept_max: int) -> None:
    """Note that a file or a folder of the cache is used, and drop those beside it that have been used least lately.

    Args:
        kept: the file or folder, which exists.
        kept_max: how many stay, it among them.

    Raises:
        OSError: the cache cannot be read or written.
    """
    os.utime(kept)
    ages = {one: one.stat().st_mtime for one in kept.parent.iterdir()}
    for old in sorted(ages, key=ages.__getitem__, reverse=True)[kept_max:]:
        if old.is_dir():
            shutil.rmtree(old, ignore_errors=True)
        else:
            old.unlink(missing_ok=True)
