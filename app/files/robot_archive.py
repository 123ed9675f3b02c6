"""Unpack robots from zip archives: `robot.json` with its URDF and meshes, at the top level or in its only folder.

The archive's directory is checked before anything is unpacked: the number, sizes and paths of its files. No more is
read than it declares.
"""

import io
import stat
import zlib
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

from planner.errors import RobotError
from planner.robots.own_robots import CARD

PACKED_BYTES_MAX, UNPACKED_BYTES_MAX = 64 << 20, 256 << 20
"""Largest archive, and largest sum of its files (bytes); described robots have 1 to 60 MB of meshes."""

FILES_MAX, DEPTH_MAX, PATH_MAX = 2000, 12, 240
"""Most entries, most folders in one another, and most characters of a path."""

_ENTRY = b"PK\x01\x02"
"""The first bytes of every entry of an archive's directory."""

_OTHERS = ("__MACOSX", ".DS_Store")
"""Files that macOS adds to archives."""

_CHUNK = 1 << 20


def unpack_robot(data: bytes, folder: Path) -> None:
    """Unpack an archive into an empty folder, so that the card is right in it.

    Raises:
        RobotError: it is no archive of a robot, or one that is too large or leads out of its folder.
        OSError: the system refuses to write.
    """
    _unpack(data, folder, _below_card)


def has_card(data: bytes) -> bool:
    """Return whether this is an archive with a robot's card in it."""
    if data.count(_ENTRY) > FILES_MAX:
        return False
    try:
        with ZipFile(io.BytesIO(data)) as archive:
            return any(PurePosixPath(name).name == CARD for name in archive.namelist())
    except (BadZipFile, ValueError, NotImplementedError):
        return False


def unpack_archive(data: bytes, folder: Path) -> None:
    """Unpack an archive that need not have a card into an empty folder; raise as `unpack_robot` does."""
    _unpack(data, folder, lambda files: files)


_Files = dict[PurePosixPath, ZipInfo]


def _unpack(data: bytes, folder: Path, chosen: Callable[[_Files], _Files]) -> None:
    # `ZipFile` makes an object of every entry, so they are counted before.
    if data.count(_ENTRY) > FILES_MAX:
        raise RobotError("file", f"has more than {FILES_MAX} files")
    try:
        with ZipFile(io.BytesIO(data)) as archive:
            entries = _checked(archive.infolist())
            for path, entry in chosen(entries).items():
                _write(archive, entry, folder / path)
    except (BadZipFile, zlib.error, ValueError, EOFError, NotImplementedError, OverflowError) as error:
        if isinstance(error, RobotError):
            raise
        raise RobotError("file", f"is no zip archive that can be read: {error}") from None


def _checked(entries: list[ZipInfo]) -> dict[PurePosixPath, ZipInfo]:
    """Return the files by their paths, once every entry is in order."""
    files: dict[PurePosixPath, ZipInfo] = {}
    known: set[str] = set()
    for entry in entries:
        _require_plain(entry)
        path = _path(entry)
        if entry.is_dir() or any(part in _OTHERS for part in path.parts):
            continue
        if str(path).casefold() in known:
            raise RobotError("file", f"has two files called {str(path)!r}")
        known.add(str(path).casefold())
        files[path] = entry
    size = sum(entry.file_size for entry in files.values())
    if size > UNPACKED_BYTES_MAX:
        raise RobotError("file", f"has {size} bytes unpacked, at most {UNPACKED_BYTES_MAX >> 20} MiB are allowed")
    for path in files:
        if any(str(parent).casefold() in known for parent in path.parents):
            raise RobotError("file", f"has {str(path)!r} below a file")
    return files


def _require_plain(entry: ZipInfo) -> None:
    """Refuse links, devices, what is encrypted, and methods of packing other than the two usual ones."""
    kind = stat.S_IFMT(entry.external_attr >> 16)
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        raise RobotError("file", f"{entry.filename!r} is a link or a device, not a file")
    if entry.flag_bits & 1:
        raise RobotError("file", f"{entry.filename!r} is encrypted")
    if entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        raise RobotError("file", f"{entry.filename!r} is packed by method {entry.compress_type}, not deflated")


def _path(entry: ZipInfo) -> PurePosixPath:
    """Return the path of an entry; refuse one that could lead anywhere else."""
    named, path = entry.filename, PurePosixPath(entry.filename)
    if path.is_absolute() or ".." in path.parts or any(sign in named for sign in "\\:\0"):
        raise RobotError("file", f"{named[:PATH_MAX]!r} leads out of the archive's folder")
    if len(named) > PATH_MAX or len(path.parts) > DEPTH_MAX or not (path.parts and named.isprintable()):
        limits = f"at most {PATH_MAX} characters and {DEPTH_MAX} folders"
        raise RobotError("file", f"{named[:PATH_MAX]!r} is no path that is taken: {limits}")
    return path


def _below_card(files: dict[PurePosixPath, ZipInfo]) -> dict[PurePosixPath, ZipInfo]:
    """Return the files by their paths below the folder of the card: the top, or the only folder there."""
    if PurePosixPath(CARD) in files:
        return files
    tops = {path.parts[0] for path in files}
    if len(tops) != 1 or PurePosixPath(*tops, CARD) not in files:
        raise RobotError("file", f"has no {CARD} at its top, nor in the only folder there")
    return {path.relative_to(*tops): entry for path, entry in files.items()}


def _write(archive: ZipFile, entry: ZipInfo, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    with archive.open(entry) as packed, target.open("xb") as file:
        left = entry.file_size
        while part := packed.read(min(_CHUNK, left + 1)):
            left -= len(part)
            if left < 0:
                raise BadZipFile(f"{entry.filename!r} is larger than its directory says")
            file.write(part)
