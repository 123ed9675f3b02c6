"""Files that are either wholly there or as they were before, whatever happens while they are written."""

import os
import tempfile
from pathlib import Path


def write_at_once(path: Path, content: bytes, *, is_synced: bool = True) -> None:
    """The whole file or nothing of it.

    Args:
        path: the file; its folder is there.
        content: what it is to contain.
        is_synced: whether it is on the disk when this returns, so that it outlives a power failure; otherwise it
            outlives the end of this process.
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
    """Have a folder's entries on the disk."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
