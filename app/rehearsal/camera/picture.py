"""Render what a camera over a table sees: the floor, the table, a cloth with two faces, the robot's arms, shadows.

No graphics card is needed: triangles are painted by OpenCV at twice the picture's resolution, farthest first. What
reads pictures shares nothing with this but the camera.
"""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.look import FloatImage, Image, Look, developed, stretched, wood
from app.rehearsal.camera.robot_shape import outlines
from planner.geometry.pose import FloatArray
from planner.geometry.table import Table

_FINER = 2
_TEXTURE_M = 0.004
_TEXTURE_PX = 700
"""Size of a texture's pixel (m), and its side: tables up to 2.8 m a side are covered, larger ones repeat it."""

_LEAST_M = 0.01
"""What is nearer to the lens is not seen (m)."""

_FLOOR = (96.0, 98.0, 100.0)
_ROBOT = (214.0, 212.0, 208.0)
_SUN = np.array([0.25, -0.35, 1.0])
"""The direction towards the light, table frame."""


@dataclass(frozen=True, slots=True, eq=False)
class ClothSeen:
    """The cloth that a camera looks at.

    Attributes:
        pattern: its points in the pattern's frame, shape (n, 2), m.
        positions: where they are, table frame, shape (n, 3), m.
        triangles: the triangles between them, counter-clockwise in the pattern, shape (m, 3).
    """

    pattern: FloatArray
    positions: FloatArray
    triangles: NDArray[np.int64]


def picture(
    camera: Camera, table: Table, cloth: ClothSeen, robot: list[FloatArray], look: Look, seed: int, moment: int = 0
) -> Image:
    """Return the picture that a camera takes: blue, green, red, shape (height, width, 3).

    Args:
        camera: the camera.
        table: the table.
        cloth: what lies on it.
        robot: the points of the robot's parts, table frame (m).
        look: colours, light and noise.
        seed: of textures and light.
        moment: of the noise: two pictures of one moment are the same.
    """
    width, height = camera.size_px
    fine = Camera(camera.position, camera.rotation, _FINER * camera.focal_px, (_FINER * width, _FINER * height))
    taken = _ground(fine, table, look, seed).copy()
    _shade(taken, fine, cloth, robot, look)
    _lay_cloth(taken, fine, cloth, look, seed)
    for number, ring in enumerate(outlines(robot, fine)):
        cv2.fillConvexPoly(taken, ring, [part * (0.86 + 0.02 * (number % 8)) for part in _ROBOT], cv2.LINE_8)
    small = np.asarray(cv2.resize(taken, (width, height), interpolation=cv2.INTER_AREA), np.float32)
    noise = np.random.default_rng([seed, moment])
    return developed(small, look, noise)


@lru_cache(maxsize=4)
def _ground(camera: Camera, table: Table, look: Look, seed: int) -> FloatImage:
    """Return the floor and the table; what does not change is kept, and must not be changed."""
    x, y = camera.all_on_table()
    texture = _texture(look, seed)
    across, down = (np.nan_to_num(axis / _TEXTURE_M + _TEXTURE_PX / 2.0) for axis in (x, y))
    grained = cv2.remap(texture, across, down, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
    is_table = (np.abs(x) <= table.depth_m / 2) & (np.abs(y) <= table.width_m / 2)
    ground = np.where(is_table[..., None], grained, np.array(_FLOOR, np.float32))
    ground.setflags(write=False)
    return np.asarray(ground, np.float32)


@lru_cache(maxsize=4)
def _texture(look: Look, seed: int) -> FloatImage:
    return wood(look, _TEXTURE_PX, np.random.default_rng([seed, 1]))


def _shade(taken: FloatImage, camera: Camera, cloth: ClothSeen, robot: list[FloatArray], look: Look) -> None:
    """Darken the table where cloth and arms keep off the light; shadows have soft edges."""
    mask = np.zeros(taken.shape[:2], np.float32)
    falls = cloth.positions - np.maximum(cloth.positions[:, 2:] + 0.006, 0.0) * _SUN
    falls[:, 2] = 0.0
    is_ahead = (camera.depths(falls) > _LEAST_M)[cloth.triangles].all(axis=1)
    fixed = np.round(camera.pixels(falls)[cloth.triangles[is_ahead]]).astype(np.int32)
    for triangle in fixed:
        cv2.fillConvexPoly(mask, triangle, 1.0)
    for part in robot:
        high = part[part[:, 2] > 0.0]
        fallen = high - high[:, 2:] * _SUN
        if len(high) > 2 and camera.depths(fallen).min() > _LEAST_M:
            ring = cv2.convexHull(np.round(camera.pixels(fallen)).astype(np.int32))
            cv2.fillConvexPoly(mask, ring, 0.6)
    taken *= 1.0 - look.shadow * cv2.GaussianBlur(mask, (0, 0), 5.0)[:, :, None]


def _lay_cloth(taken: FloatImage, camera: Camera, cloth: ClothSeen, look: Look, seed: int) -> None:
    pixels = camera.pixels(cloth.positions)
    numbers = drawn(pixels - 0.25, cloth.triangles, camera.depths(cloth.positions), camera.size_px)
    if numbers.max() < 0:
        return
    shown, near = shares(numbers, pixels, cloth.triangles)
    corners = cloth.triangles[numbers[shown]]
    on = np.einsum("ij,ijk->ik", near, cloth.pattern[corners])
    colours = _colours(on, _is_front(camera, cloth)[numbers[shown]], look)
    brightness = np.einsum("ij,ij->i", near, _brightness(cloth)[corners])
    folds, weave = _wrinkles(seed)
    places = np.floor(on / _TEXTURE_M).astype(np.int64) % 256
    wrinkles = look.wrinkles * folds[places[:, 0], places[:, 1]] + weave[places[:, 1], places[:, 0]]
    taken[shown] = colours * brightness[:, None] + wrinkles[:, None]


@lru_cache(maxsize=4)
def _wrinkles(seed: int) -> tuple[FloatImage, FloatImage]:
    """Return the brightness that wrinkles and weave add (of 255)."""
    rng = np.random.default_rng(seed)
    folds, weave = stretched(rng, 256, (10, 20), 1.5), stretched(rng, 256, (1, 1), 0.0)
    return np.asarray(18 * folds / folds.std(), np.float32), 3 * weave


def _colours(on: FloatArray, is_front: NDArray[np.bool_], look: Look) -> FloatArray:
    """Return the colours of points of the pattern, shape (n, 2) -> (n, 3)."""
    back = look.cloth if look.back is None else look.back
    colours = np.where(is_front[:, None], np.array(look.cloth), np.array(back))
    if look.pattern != "plain":
        waves = np.sin(on[:, 1] * 2 * np.pi / 0.05) > 0.3
        if look.pattern == "checks":
            waves ^= np.sin(on[:, 0] * 2 * np.pi / 0.05) > 0.3
        colours[waves] = np.clip(255 - colours[waves] * 0.7, 15, 240)
    return np.asarray(colours)


def _is_front(camera: Camera, cloth: ClothSeen) -> NDArray[np.bool_]:
    """Return which triangles show their front, shape (m,)."""
    a, b, c = (cloth.positions[cloth.triangles[:, i]] for i in range(3))
    towards = np.array(camera.position) - (a + b + c) / 3.0
    return np.asarray((np.cross(b - a, c - a) * towards).sum(axis=1) > 0.0)


def _brightness(cloth: ClothSeen) -> FloatArray:
    """Return how bright the cloth is at its points, by how it faces the light, shape (n,), about 1."""
    a, b, c = (cloth.positions[cloth.triangles[:, i]] for i in range(3))
    facing = np.cross(b - a, c - a)
    facing *= np.where(facing[:, 2:] < 0.0, -1.0, 1.0)
    normals = np.zeros_like(cloth.positions)
    for corner in range(3):
        np.add.at(normals, cloth.triangles[:, corner], facing)
    lengths = np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    flat = float(_SUN[2] / np.linalg.norm(_SUN))
    return np.asarray(0.55 + 0.45 * np.maximum(normals @ _SUN / np.linalg.norm(_SUN) / lengths, 0.0) / flat)


Numbers = NDArray[np.int32]

_SHIFT = 4
_FINE = 1 << _SHIFT
"""Corners of triangles are at sixteenths of a pixel."""


def drawn(pixels: FloatArray, triangles: NDArray[np.int64], depths: FloatArray, size_px: tuple[int, int]) -> Numbers:
    """Return which triangle each pixel shows, shape (height, width); -1 where it shows none.

    The triangles are painted one over the other, the farthest first: cloth that lies in layers has no triangles that
    run through each other. Those that are at the lens or behind it are left out.

    Args:
        pixels: where the vertices are in the image, shape (n, 2).
        triangles: shape (m, 3).
        depths: how far ahead of the camera the vertices are, shape (n,), m.
        size_px: the image's width and height.
    """
    numbers = np.full(size_px[::-1], -1, np.int32)
    ahead = np.flatnonzero(depths[triangles].min(axis=1) > _LEAST_M)
    corners = np.clip(pixels, -4.0 * max(size_px), 4.0 * max(size_px))
    fixed = np.round(corners[triangles] * _FINE).astype(np.int32)
    for number in ahead[np.argsort(-depths[triangles[ahead]].mean(axis=1), kind="stable")].tolist():
        cv2.fillConvexPoly(numbers, fixed[number], number, cv2.LINE_8, _SHIFT)
    return numbers


def shares(numbers: Numbers, pixels: FloatArray, triangles: NDArray[np.int64]) -> tuple[NDArray[np.bool_], FloatArray]:
    """Return which pixels show a triangle, and the barycentric coordinates of each in its triangle, shape (k, 3).

    Perspective within one triangle is left out: they are small.
    """
    shown = numbers >= 0
    rows, columns = np.nonzero(shown)
    (ax, ay), (bx, by), (cx, cy) = pixels[triangles[numbers[shown]]].transpose(1, 2, 0)
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    area = np.where(np.abs(area) < 1e-6, 1e-6, area)
    second = ((columns - ax) * (cy - ay) - (rows - ay) * (cx - ax)) / area
    third = ((bx - ax) * (rows - ay) - (by - ay) * (columns - ax)) / area
    found = np.clip(np.column_stack([1.0 - second - third, second, third]), 0.0, 1.0)
    return shown, np.asarray(found / found.sum(axis=1, keepdims=True))
