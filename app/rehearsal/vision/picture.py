"""Read a picture: PNG or JPEG, of bounded size, upright as its EXIF says, with what it tells of its camera."""

import math
import struct
import warnings
from dataclasses import dataclass
from io import BytesIO
from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.vision.table_plane import USUAL_FOCAL, Focal
from app.rehearsal.vision.vision_errors import LARGEST_PICTURE, PictureError
from planner.message import Message

Image: TypeAlias = NDArray[np.uint8]

LEAST_SIDE, MOST_SIDE, MOST_PIXELS = 160, 12_000, 50_000_000
"""Least and most pixels of a side, and of the whole picture; more is not decoded."""

WORKED_SIDE = 1400
"""The longer side to which pictures are reduced (pixels); finer ones show no more of an edge."""

SEEN_THROUGH = (0.03, 0.999)
"""The range of the share of transparent pixels of a cut-out."""

_BEHIND = 110
"""The grey that transparent pixels are given (of 255): paler than dark cloth, darker than paper."""

_OPAQUE = 128

_TAKEN = 5
"""The number of frames that a camera takes until its exposure has settled."""

_FOCAL_SPREAD = 0.04
"""Standard deviation of the logarithm of a focal length that EXIF tells: it is rounded, and lenses breathe."""

_FOCALS = (0.3, 10.0)
"""Range of focal lengths that are believed, in longer sides of the picture."""

_FILM_DIAGONAL_MM = math.hypot(36.0, 24.0)

_EXIF_IFD, _FOCAL_MM, _FOCAL_35_MM = 0x8769, 0x920A, 0xA405
_WIDTH, _HEIGHT, _X_PER_UNIT, _UNIT = 0xA002, 0xA003, 0xA20E, 0xA210
_UNITS_MM = {2: 25.4, 3: 10.0}
"""Numbers of EXIF: its block, focal lengths, the size of the picture as taken, pixels per unit of the sensor."""

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


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture that was read.

    Attributes:
        image: blue, green, red; the longer side at most `WORKED_SIDE`.
        alpha: how opaque its pixels are (of 255), where it is a cut-out; else None.
        focal: what is known of the camera's focal length.
    """

    image: Image
    alpha: Image | None
    focal: Focal


def read_picture(data: bytes) -> Picture:
    """Return a picture, upright and not too large.

    Raises:
        PictureError: the field is ``file``; says what is wrong with it.
    """
    _require_size(*_size(data))
    if len(data) > LARGEST_PICTURE:
        raise _broken(f"the picture has {len(data)} bytes, more than {LARGEST_PICTURE}")
    image, alpha = _decoded(data, cv2.IMREAD_COLOR), _alpha(data)
    if alpha is not None:
        share = np.asarray(alpha, np.float32)[:, :, None] / np.float32(255)
        image = np.asarray((image - np.float32(_BEHIND)) * share + np.float32(_BEHIND), np.uint8)
        is_cut_out = SEEN_THROUGH[0] <= float((alpha < _OPAQUE).mean()) <= SEEN_THROUGH[1]
        alpha = alpha if is_cut_out else None
    return Picture(_shrunk(image), None if alpha is None else _shrunk(alpha), _focal(data, image.shape))


def device_image(number: int) -> Image:
    """Return the picture that a camera of this machine takes now; raises `PictureError` if it gives none."""
    device = cv2.VideoCapture(number)
    try:
        taken = [device.read() for _ in range(_TAKEN)]
    finally:
        device.release()
    is_taken, image = taken[-1]
    if not is_taken:
        raise _broken("the camera gives no picture")
    return np.asarray(image, np.uint8)


def _decoded(data: bytes, how: int) -> Image:
    try:
        decoded = cv2.imdecode(np.frombuffer(data, np.uint8), how)
    except cv2.error:
        decoded = None
    if decoded is None:
        raise _broken("the picture is damaged or cut off: it cannot be decoded")
    return np.asarray(decoded, np.uint8 if decoded.dtype == np.uint8 else np.uint16)


def _shrunk(image: Image) -> Image:
    share = WORKED_SIDE / max(image.shape[:2])
    if share >= 1.0:
        return image
    return np.asarray(cv2.resize(image, None, fx=share, fy=share, interpolation=cv2.INTER_AREA), np.uint8)


def _alpha(data: bytes) -> Image | None:
    """Return how opaque a PNG's pixels are (of 255); None where all are."""
    if not data.startswith(_PNG):
        return None
    decoded = _decoded(data, cv2.IMREAD_UNCHANGED)
    if decoded.ndim < 3 or decoded.shape[2] != 4:
        return None
    alpha = decoded[:, :, 3]
    return np.asarray(alpha if alpha.dtype == np.uint8 else alpha >> 8, np.uint8)


def _focal(data: bytes, shape: tuple[int, ...]) -> Focal:
    """Return the focal length that a picture's EXIF tells; the usual one where it tells none, or was cropped.

    Args:
        data: the file.
        shape: the picture's height and width, upright (pixels).
    """
    tags = _exif(data)
    longer, shorter = float(max(shape[:2])), float(min(shape[:2]))
    taken = sorted(float(tags.get(tag, 0.0)) for tag in (_WIDTH, _HEIGHT))
    if taken[0] > 0 and abs(taken[1] / taken[0] / (longer / shorter) - 1.0) > 0.02:
        return USUAL_FOCAL
    sides = 0.0
    if tags.get(_FOCAL_35_MM, 0.0) > 0:
        sides = tags[_FOCAL_35_MM] / _FILM_DIAGONAL_MM * math.hypot(longer, shorter) / longer
    elif min(tags.get(tag, 0.0) for tag in (_FOCAL_MM, _X_PER_UNIT)) > 0 and taken[1] > 0:
        sides = tags[_FOCAL_MM] * tags[_X_PER_UNIT] / _UNITS_MM.get(int(tags.get(_UNIT, 2.0)), 25.4) / taken[1]
    return Focal(sides, _FOCAL_SPREAD) if _FOCALS[0] <= sides <= _FOCALS[1] else USUAL_FOCAL


def _exif(data: bytes) -> dict[int, float]:
    """Return the numbers in a picture's EXIF, by tag; none where it has no EXIF or a damaged one."""
    from PIL import Image as Pillow  # here, because only pictures need it

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            block: dict[int, Any] = Pillow.open(BytesIO(data)).getexif().get_ifd(_EXIF_IFD)
        except (OSError, ValueError, SyntaxError, TypeError, KeyError, struct.error):
            return {}
    return {tag: number for tag, value in block.items() if (number := _number(value)) is not None}


def _number(value: object) -> float | None:
    """Return a finite number of EXIF, whose fractions may have a denominator of 0; None for anything else."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, ZeroDivisionError, OverflowError):
        return None
    return number if math.isfinite(number) else None


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
