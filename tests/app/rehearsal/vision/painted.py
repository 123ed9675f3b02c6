"""Simple pictures for tests: figures on a table seen by a pinhole camera, painted here."""

import io
import math
from collections.abc import Sequence

import cv2
import numpy as np
from PIL import Image as Pillow

from app.rehearsal.vision.picture import Image
from planner import load_garment
from planner.geometry.pose import FloatArray, Pose2

WOOD, BLUE, PAPER, FLOOR = (110, 150, 190), (150, 70, 40), (246, 247, 248), (70, 72, 74)
A4_M = (0.297, 0.210)
SIZE = (1200, 900)
_FINER = 3


def garment(name: str, x_m: float = 0.0, y_m: float = 0.0, yaw_rad: float = 0.3) -> FloatArray:
    """Return a shipped garment's outline about a place, shape (n, 2), m."""
    outline = np.array(load_garment(name).outline)
    return Pose2(x_m, y_m, yaw_rad).to_outer(outline - (outline.min(axis=0) + outline.max(axis=0)) / 2.0)


def rectangle(x_m: float, y_m: float, sides_m: tuple[float, float], yaw_rad: float = 0.4) -> FloatArray:
    """Return the corners of a rectangle, shape (4, 2), m."""
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * np.array(sides_m) / 2.0
    return Pose2(x_m, y_m, yaw_rad).to_outer(corners)


def striped(ring: FloatArray, along_rad: float, width_m: float) -> list[FloatArray]:
    """Return every other stripe of a convex figure, so wide, as rings; the first and last are stripes."""
    turned = Pose2(0.0, 0.0, along_rad).to_inner(ring)
    low, high = float(turned[:, 1].min()), float(turned[:, 1].max())
    count = 2 * round((high - low) / width_m / 2.0) + 1
    levels = np.linspace(low, high, count + 1)
    wide = np.array([[-9.0, 0.0], [9.0, 0.0], [9.0, 1.0], [-9.0, 1.0]])
    rings = []
    for k in range(0, count, 2):
        band = wide * [1.0, levels[k + 1] - levels[k]] + [0.0, levels[k]]
        _, cut = cv2.intersectConvexConvex(turned.astype(np.float32), band.astype(np.float32))
        rings.append(Pose2(0.0, 0.0, along_rad).to_outer(cut[:, 0].astype(np.float64)))
    return rings


def taken(
    figures: Sequence[tuple[FloatArray, tuple[int, int, int]]],
    ground: tuple[int, int, int] = WOOD,
    *,
    tilt_rad: float = 0.0,
    focal: float = 0.95,
    width_m: float = 2.2,
    noise: float = 3.0,
) -> Image:
    """Return the picture of figures, bottom to top, each a ring (m) and its colour; the width is that in the middle.

    Args:
        figures: rings, table frame, shape (n, 2), m, and colours (blue, green, red).
        ground: the colour of all the rest.
        tilt_rad: how far the camera leans from straight above.
        focal: its focal length, in longer sides of the picture.
        width_m: how much of the table the picture is wide.
        noise: standard deviation of the noise (of 255).
    """
    width, height = SIZE[0] * _FINER, SIZE[1] * _FINER
    image = np.full((height, width, 3), ground, np.uint8)
    for ring, colour in figures:
        cv2.fillPoly(image, [_pixels(ring, tilt_rad, focal, width_m, (width, height)).round().astype(np.int32)], colour)
    small = cv2.resize(image, SIZE, interpolation=cv2.INTER_AREA).astype(np.float32)
    rough = cv2.GaussianBlur(small, (0, 0), 0.8) + np.random.default_rng(0).normal(0.0, noise, small.shape)
    return np.asarray(np.clip(rough, 0, 255), np.uint8)


def _pixels(ring: FloatArray, tilt_rad: float, focal: float, width_m: float, size: tuple[int, int]) -> FloatArray:
    """Return where a ring is seen, its edges divided so that fillPoly's whole pixels do not matter."""
    c, s, far = math.cos(tilt_rad), math.sin(tilt_rad), focal * width_m
    x, y = ring.T
    depth = far + s * y
    return np.column_stack([x / depth, -c * y / depth]) * focal * size[0] + np.array(size) / 2.0


def jpeg(image: Image, focal_35_mm: int | None = None) -> bytes:
    """Return a picture as a JPEG, with a focal length in its EXIF if one is given."""
    exif = Pillow.Exif()
    if focal_35_mm is not None:
        exif.get_ifd(0x8769)[0xA405] = focal_35_mm
    file = io.BytesIO()
    Pillow.fromarray(image[:, :, ::-1]).save(file, "JPEG", quality=92, exif=exif)
    return file.getvalue()


def cut_out(rings: Sequence[FloatArray], colour: int = 12, *, is_trimmed: bool = False, soft: float = 0.0) -> bytes:
    """Return a PNG, 1000 pixels a metre, whose background is transparent, black behind; its edges may be soft."""
    low = np.min([ring.min(axis=0) for ring in rings], axis=0)
    wide = np.max([ring.max(axis=0) for ring in rings], axis=0) - low
    margin = 0 if is_trimmed and not soft else 60
    columns, rows = (np.ceil(1000 * wide) + 2 * margin).astype(int)
    alpha = np.zeros((rows, columns), np.uint8)
    for ring in rings:
        cells = (1000 * (ring - low) * [1.0, -1.0] + [margin, 1000 * wide[1] + margin - 1]).round().astype(np.int32)
        cv2.fillPoly(alpha, [cells], 255)
    if soft:
        alpha = np.asarray(cv2.GaussianBlur(alpha, (0, 0), soft), np.uint8)
    if is_trimmed:
        alpha = alpha[np.ix_(alpha.any(axis=1), alpha.any(axis=0))]
    grey = np.where(alpha > 0, colour, 0).astype(np.uint8)
    return cv2.imencode(".png", np.dstack([grey, grey, grey, alpha]))[1].tobytes()
