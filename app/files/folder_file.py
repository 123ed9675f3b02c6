"""A folder as one file: zipped for a download, unpacked on the command line."""

import errno
import io
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path

ZIP = ".zip"
"""The ending of a zipped folder."""

_LONG_AGO = (1980, 1, 1, 0, 0, 0)
"""The time of every file inside, so that equal folders are equal files."""


def zipped(files: Mapping[str, bytes]) -> bytes:
    """Return files as a zip archive.

    Args:
        files: the content of each by its path in the folder, with `/` between names.
    """
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            archive.writestr(zipfile.ZipInfo(path, _LONG_AGO), content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def unpack(packed: bytes, folder: Path) -> None:
    """Write the files of an archive that `zipped` made into a new or empty folder; raise `OSError` for any other."""
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise FileExistsError(errno.ENOTEMPTY, os.strerror(errno.ENOTEMPTY), str(folder))
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        archive.extractall(folder)
