"""Renders pictures of cloth on a table as a camera over it might take them.

Nothing of the program that looks at pictures is used here. The table is painted from above, 2 mm a pixel: a texture,
soft shadows, cloth with wrinkles and a pattern, a sheet of paper or a marker. A pinhole camera, tilted, takes it; an
arm may reach into the picture; then come uneven light, blur, noise and JPEG.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.camera.look import Look, coded, developed, stretched, wood

FloatArray = NDArray[np.float64]
Image = NDArray[np.uint8]

PIXEL_M = 0.002
SIDE_M = 3.2
"""The painted part of the table's plane, its middle at the origin (m)."""

A4_M = (0.297, 0.210)
SIZE = (1280, 960)


@dataclass(frozen=True, slots=True, eq=False)
class Photo:
    """A picture and the camera that took it.

    Attributes:
        image: blue, green, red.
        to_pixels: the homography from the table's plane (m) to pixels, shape (3, 3).
        jpeg: the picture as a file.
    """

    image: Image
    to_pixels: FloatArray
    jpeg: bytes

    def pixels(self, points: FloatArray) -> FloatArray:
        """Return where points of the table, shape (n, 2), m, are in the picture."""
        return mapped(self.to_pixels, points)

    def on_table(self, pixels: FloatArray) -> FloatArray:
        """Return where pixels, shape (n, 2), are on the table (m)."""
        return mapped(np.asarray(np.linalg.inv(self.to_pixels), np.float64), pixels)


def mapped(homography: FloatArray, points: FloatArray) -> FloatArray:
    """Return the images of points, shape (n, 2), under a homography."""
    across = np.column_stack([points, np.ones(len(points))]) @ homography.T
    return np.asarray(across[:, :2] / across[:, 2:])


def photo(
    layers: Sequence[FloatArray],
    look: Look,
    seed: int,
    sheet: tuple[float, float, float] | None = None,
    sheet_m: tuple[float, float] = A4_M,
    marker: tuple[float, float, float, float] | None = None,
) -> Photo:
    """Return a picture of layers of cloth on the table.

    Args:
        layers: rings of points on the table, bottom to top, each shape (n, 2), m.
        look: what the picture is like.
        seed: of all chance.
        sheet: where the middle of a sheet of paper lies (m) and how it is turned (rad); None for none.
        sheet_m: its sides (m).
        marker: where an ArUco marker lies (m, m, rad) and its side (m); None for none.
    """
    rng = np.random.default_rng(seed)
    plane = wood(look, int(SIDE_M / PIXEL_M), rng)
    for level, ring in enumerate(layers):
        _lay_cloth(plane, _wobbled(ring, look.wobble_m, rng), look, level, rng)
    if sheet is not None:
        _shade(plane, [_rectangle(sheet, sheet_m)], look.shadow * 0.3, 2, rng)
        _lay(plane, _rectangle(sheet, sheet_m), (244.0, 246.0, 247.0))
    if marker is not None:
        _lay_marker(plane, marker)
    to_pixels = _camera(look, rng)
    half = SIDE_M / 2 / PIXEL_M - 0.5  # the middle of the first pixel is at 0
    to_plane = np.array([[1 / PIXEL_M, 0, half], [0, -1 / PIXEL_M, half], [0, 0, 1.0]])
    painted = cv2.warpPerspective(
        plane, to_pixels @ np.linalg.inv(to_plane), SIZE, flags=cv2.INTER_AREA, borderMode=cv2.BORDER_REFLECT
    )
    taken = np.asarray(painted, np.float32)
    if look.has_arm:
        _reach_in(taken, rng)
    data = coded(developed(taken, look, rng), look.quality)
    return Photo(np.asarray(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR), np.uint8), to_pixels, data)


def _covered(ring: FloatArray) -> NDArray[np.float32]:
    """Return how much of each pixel of the plane a figure covers; fillPoly alone makes figures 1 mm too large."""
    side, finer = int(SIDE_M / PIXEL_M), 4
    cells = _cells(ring, exact=True)
    low = np.clip(np.floor(cells.min(axis=0)).astype(int) - 1, 0, side)
    width, height = np.clip(np.ceil(cells.max(axis=0)).astype(int) + 2, 0, side) - low
    fine = np.zeros((finer * height, finer * width), np.uint8)
    cv2.fillPoly(fine, [np.asarray(((cells - low) * finer - 0.5).round(), np.int32)], 255)
    cover = np.zeros((side, side), np.float32)
    part = cv2.resize(fine, (int(width), int(height)), interpolation=cv2.INTER_AREA)
    cover[low[1] : low[1] + height, low[0] : low[0] + width] = np.asarray(part, np.float32) / np.float32(255)
    return cover


def _lay(plane: NDArray[np.float32], ring: FloatArray, colour: tuple[float, float, float]) -> None:
    plane += _covered(ring)[:, :, None] * (np.asarray(colour, np.float32) - plane)


def _lay_cloth(plane: NDArray[np.float32], ring: FloatArray, look: Look, level: int, rng: np.random.Generator) -> None:
    _shade(plane, [ring], look.shadow, 6, rng)
    mask = _covered(ring)
    rows, columns = np.mgrid[: plane.shape[0], : plane.shape[1]].astype(np.float32) * PIXEL_M
    colour = np.full_like(plane, look.cloth)
    if look.pattern != "plain":
        waves = np.sin(rows * 2 * math.pi / 0.05) > 0.3
        if look.pattern == "checks":
            waves ^= np.sin(columns * 2 * math.pi / 0.05) > 0.3
        colour[waves] = np.clip(255 - colour[waves] * 0.7, 15, 240)
    folds = stretched(rng, plane.shape[0], (10, 20), 1.5)
    weave = stretched(rng, plane.shape[0], (1, 1), 0.0)
    shade = look.wrinkles * 18 * folds / folds.std() + 3 * weave - 3 * level
    plane += mask[:, :, None] * (colour + shade[:, :, None] - plane)


def _shade(
    plane: NDArray[np.float32], rings: list[FloatArray], dark: float, soft: int, rng: np.random.Generator
) -> None:
    mask = np.zeros(plane.shape[:2], np.float32)
    offset = rng.uniform(-0.012, 0.012, 2)
    cv2.fillPoly(mask, [_cells(ring + offset) for ring in rings], 1.0)
    plane *= 1.0 - dark * cv2.GaussianBlur(mask, (0, 0), soft)[:, :, None]


def _lay_marker(plane: NDArray[np.float32], marker: tuple[float, float, float, float]) -> None:
    x, y, yaw, side_m = marker
    _lay(plane, _rectangle((x, y, yaw), (1.4 * side_m, 1.4 * side_m)), (245.0, 245.0, 245.0))
    cells = cv2.aruco.generateImageMarker(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50), 7, 240)
    ring = _rectangle((x, y, yaw), (side_m, side_m))[[3, 2, 1, 0]]  # as the picture's: clockwise from the top left
    to = cv2.getPerspectiveTransform(
        np.array([[0, 0], [240, 0], [240, 240], [0, 240]], np.float32), np.asarray(_cells(ring, exact=True), np.float32)
    )
    size = plane.shape[1::-1]
    cover = cv2.warpPerspective(np.ones((240, 240), np.float32), to, size)[:, :, None]
    plane += cover * (cv2.warpPerspective(np.asarray(cells, np.float32), to, size)[:, :, None] - plane)


def _camera(look: Look, rng: np.random.Generator) -> FloatArray:
    """Return the homography of a pinhole camera that looks near the origin from a random side."""
    focal = 0.62 * SIZE[0] * look.height_m / 1.25
    side, roll = rng.uniform(-math.pi, math.pi), rng.uniform(-0.15, 0.15)
    back = np.array([math.cos(side) * math.sin(look.tilt_rad), math.sin(side) * math.sin(look.tilt_rad), 0.0])
    back[2] = math.cos(look.tilt_rad)
    up = np.array([math.sin(roll), math.cos(roll), 0.0])
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    rotation = np.array([right, -np.cross(back, right), -back])
    place = -rotation @ (look.height_m * back + np.array([*rng.uniform(-0.05, 0.05, 2), 0.0]))
    intrinsic = np.array([[focal, 0, SIZE[0] / 2], [0, focal, SIZE[1] / 2], [0, 0, 1.0]])
    return np.asarray(intrinsic @ np.column_stack([rotation[:, :2], place]))


def _reach_in(taken: NDArray[np.float32], rng: np.random.Generator) -> None:
    """Paint an arm: a grey bar from the picture's border to its tip not far from the middle, with a darker hand."""
    width, height = SIZE
    angle = rng.uniform(-math.pi, math.pi)
    tip = np.array([width / 2, height / 2]) + rng.uniform(120, 320) * np.array([math.cos(angle), math.sin(angle)])
    root = tip + 1200 * np.array([math.cos(angle + 0.3), math.sin(angle + 0.3)])
    grey = float(rng.uniform(60, 200))
    cv2.line(taken, _pixel(tip), _pixel(root), (grey, grey, grey * 0.98), 70, cv2.LINE_AA)
    cv2.circle(taken, _pixel(tip), 42, (40.0, 40.0, 42.0), -1, cv2.LINE_AA)


def _wobbled(ring: FloatArray, wobble_m: float, rng: np.random.Generator) -> FloatArray:
    """Return a ring with its edges cut into pieces of 1 cm, each point a little off, neighbours alike."""
    closed = np.vstack([ring, ring[:1]])
    lengths = np.hypot(*np.diff(closed, axis=0).T)
    reached = np.concatenate([[0.0], lengths.cumsum()])
    places = np.linspace(0.0, reached[-1], max(16, int(reached[-1] / 0.01)), endpoint=False)
    points = np.column_stack([np.interp(places, reached, closed[:, axis]) for axis in (0, 1)])
    off = rng.normal(0, 1, points.shape)
    smooth = sum(np.roll(off, k, axis=0) for k in range(-3, 4)) / math.sqrt(7)
    return np.asarray(points + wobble_m * smooth)


def _rectangle(pose: tuple[float, float, float], sides_m: tuple[float, float]) -> FloatArray:
    x, y, yaw = pose
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * np.array(sides_m) / 2
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    return np.asarray(corners @ turn.T + np.array([x, y]))


def _cells(ring: FloatArray, *, exact: bool = False) -> NDArray[np.int32]:
    """Return points of the table as pixels of the painted plane."""
    cells = np.column_stack([ring[:, 0], -ring[:, 1]]) / PIXEL_M + SIDE_M / 2 / PIXEL_M
    return np.asarray(cells) if exact else np.asarray(cells.round(), np.int32)


def _pixel(point: FloatArray) -> tuple[int, int]:
    return (round(float(point[0])), round(float(point[1])))
