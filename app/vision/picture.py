"""Read a picture: PNG or JPEG, of bounded size, upright as its EXIF says."""

import struct
from typing import TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray

from app.vision.vision_errors import PictureError
from planner.message import Message

Image: TypeAlias = NDArray[np.uint8]

LARGEST_PICTURE = 16 << 20
"""Largest size of a picture's file (bytes)."""

LEAST_SIDE, MOST_SIDE, MOST_PIXELS = 160, 12_000, 50_000_000
"""Least and most pixels of a side, and of the whole picture; more is not decoded."""

WORKED_SIDE = 1400
"""The longer side of a picture as it is worked on (pixels); finer ones tell no more of a cloth's edge."""

_OTHERS = {
    b"GIF8": "a GIF",
    b"BM": "a BMP",
    b"II*\0": "a TIFF",
    b"MM\0*": "a TIFF",
    b"%PDF": "a PDF",
    b"\x00\x00\x00\x0cjP  ": "a JPEG 2000",
}
_FTYP = {b"heic": "HEIC", b"heix": "HEIC", b"hevc": "HEIC", b"mif1": "HEIF", b"msf1": "HEIF", b"avif": "AVIF"}
_PNG, _JPEG = b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"
_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}


def read_picture(data: bytes) -> Image:
    """Return a picture, blue, green, red, its longer side at most `WORKED_SIDE`.

    Raises:
        PictureError: the field is ``file``; says what is wrong with it.
    """
    _require_size(*_size(data))
    if len(data) > LARGEST_PICTURE:
        raise _broken(f"the picture has {len(data)} bytes, more than {LARGEST_PICTURE}")
    try:
        decoded = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    except cv2.error:
        decoded = None
    if decoded is None:
        raise _broken("the picture is damaged or cut off: it cannot be decoded")
    image = np.asarray(decoded, np.uint8)
    share = WORKED_SIDE / max(image.shape[:2])
    if share >= 1.0:
        return image
    return np.asarray(cv2.resize(image, None, fx=share, fy=share, interpolation=cv2.INTER_AREA), np.uint8)


def _size(data: bytes) -> tuple[int, int]:
    """Return width and height as the file's head says, before anything is decoded."""
    if data.startswith(_PNG):
        if len(data) < 24 or data[12:16] != b"IHDR":
            raise _broken("the PNG is damaged: it does not begin with its size")
        width, height = struct.unpack(">II", data[16:24])
        return int(width), int(height)
    if data.startswith(_JPEG):
        return _jpeg_size(data)
    raise _broken(f"{_kind(data)}; a picture has to be a PNG or a JPEG")


def _jpeg_size(data: bytes) -> tuple[int, int]:
    """Return the size in a JPEG's frame header."""
    at = 2
    while at + 9 < len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker in _FRAMES:
            height, width = struct.unpack(">HH", data[at + 5 : at + 9])
            return int(width), int(height)
        at += 1 if marker == 0xFF else 2 + int.from_bytes(data[at + 2 : at + 4])
    raise _broken("the JPEG is damaged or cut off: it says no size")


def _kind(data: bytes) -> str:
    """Return what a file seems to be, in words."""
    if not data:
        return "the file is empty"
    if data[4:8] == b"ftyp":
        return f"the file is {_FTYP.get(data[8:12], 'a film or another picture format')}"
    if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        return "the file is a WebP"
    return next(
        (f"the file is {name}" for start, name in _OTHERS.items() if data.startswith(start)),
        "the file is of no kind that is known",
    )


def _require_size(width: int, height: int) -> None:
    if not (min(width, height) >= LEAST_SIDE and max(width, height) <= MOST_SIDE and width * height <= MOST_PIXELS):
        text = (
            f"the picture is {width} by {height} pixels; a side has {LEAST_SIDE} to {MOST_SIDE}, all of it at most "
            f"{MOST_PIXELS:,}"
        )
        values = {"size": [width, height], "sides": [LEAST_SIDE, MOST_SIDE], "most": MOST_PIXELS}
        raise PictureError("file", Message("picture_size", text, values))


def _broken(message: str) -> PictureError:
    return PictureError("file", message)
