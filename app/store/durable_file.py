"""Writes files atomically: afterwards a file is either complete or as before, even if writing is interrupted."""

import os
import tempfile
from pathlib import Path


def write_at_once(path: Path, content: bytes, *, is_synced: bool = True) -> None:
    """Write a file atomically.

    Args:
        path: the file; its folder must exist.
        content: its content.
        is_synced: whether to return only when it is on the disk, so that it survives a power failure; otherwise it
            survives only the end of this process.
    """
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.stem}-", delete=False) as file:
        try:
            file.write(content)
            file.flush()
            if is_synced:
                os.fsync(file.fileno())
            Path(file.name).replace(path)
        except BaseException:
            Path(file.name).unlink(missing_ok=True)
            raise
    if is_synced:
        sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Write a folder's entries to the disk."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
