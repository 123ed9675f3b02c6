"""A robot's folder as one archive for the database, and a digest of its files by which copies are compared."""

import hashlib
import io
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from app.store.durable_file import sync_folder

_ZIP_LEVEL = 1
"""Compression level: meshes compress to about a half already, and a robot of 60 MB is packed within seconds."""


def files_of(folder: Path) -> list[Path]:
    """Return the files of a folder, in the order of their paths below it."""
    return sorted((path for path in folder.rglob("*") if path.is_file()), key=lambda path: path.relative_to(folder))


def digest_of(folder: Path) -> str:
    """Return a digest of the paths and the contents of a folder's files; raises `OSError`."""
    whole = hashlib.sha256()
    for path in files_of(folder):
        with path.open("rb") as file:
            content = hashlib.file_digest(file, "sha256").hexdigest()
        whole.update(f"{path.relative_to(folder).as_posix()}\0{content}\n".encode("utf-8", "surrogateescape"))
    return whole.hexdigest()


def packed(folder: Path) -> bytes:
    """Return an archive of a folder's files; raises `OSError`."""
    target = io.BytesIO()
    with ZipFile(target, "w", ZIP_DEFLATED, compresslevel=_ZIP_LEVEL) as archive:
        for path in files_of(folder):
            archive.writestr(ZipInfo(path.relative_to(folder).as_posix()), path.read_bytes(), ZIP_DEFLATED, _ZIP_LEVEL)
    return target.getvalue()


def unpack(content: bytes, folder: Path) -> None:
    """Unpack an archive that `packed` has made into an empty folder; raises `OSError`."""
    with ZipFile(io.BytesIO(content)) as archive:
        archive.extractall(folder)
    sync_tree(folder)


def sync_tree(folder: Path) -> None:
    """Write the entries of a folder, and of all folders below it, to the disk."""
    for path in (folder, *(one for one in folder.rglob("*") if one.is_dir())):
        sync_folder(path)
