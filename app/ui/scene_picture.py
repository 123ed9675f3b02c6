"""Pictures of what the 3D view shows, painted without a browser: the same meshes, colours and lights, soft shadows.

Everything is painted at twice the picture's resolution. A shadow is what the sun's rays carry down to the table and to
the floor, blurred; so cloth and robot shade what they stand over, and not each other.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageFilter

from app.ui.colours import Palette, Rgb
from app.ui.painter import Triangles, nearest
from app.ui.robot_model import Pose3, load_robot_model
from app.ui.robot_view import link_colour
from app.ui.rotation import yaw
from app.ui.thick_cloth import ThickCloth, blended_normals
from app.ui.viewpoint import Viewpoint
from app.ui.weave import woven
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import table_parts
from planner.motion.timeline import Sample
from planner.robots.card import RobotCard
from planner.task.scene import Scene

_FINER = 2
_SUN = np.array([0.25, -0.2, 1.0])
_LAMPS = ((_SUN, 0.30), (np.array([2.0, 2.6, 2.2]), 0.16), (np.array([-2.6, -1.6, 1.3]), 0.12))
"""The directions towards the lights, table frame, and how much of the light of a level surface each gives, about."""

_SKY, _LEVEL = 0.55, 0.94
"""The light from everywhere, and all light on a level surface."""

_SHADOW, _BLUR_PX = 0.34, 1.5
_FAR_M, _BEYOND = 11.0, 1.15
"""How far from the table the floor ends (m), and how much brighter it is there."""

_COARSER = 2
"""Shadows are painted at the picture's resolution divided by this."""

_BOX = [(0, 1, 3), (0, 3, 2), (4, 7, 5), (4, 6, 7), (0, 5, 1), (0, 4, 5)]
_BOX += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 7, 3), (1, 5, 7)]
_CORNERS = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])[np.array(_BOX).ravel()]
"""The corners of a box's triangles, three for each."""


@dataclass(frozen=True, slots=True)
class Part:
    """A mesh of one colour: vertices and their normals, shape (n, 3), and triangles."""

    vertices: FloatArray
    normals: FloatArray
    triangles: Triangles
    colour: Rgb

    @staticmethod
    def of(vertices: FloatArray, triangles: Triangles, colour: Rgb, *, is_closed: bool = False) -> "Part":
        """Return a mesh with the normals of its triangles, blended at shared vertices; a closed one faces outwards."""
        a, b, c = vertices[triangles].transpose(1, 0, 2)
        inside_out = is_closed and float((np.cross(a, b) * c).sum()) < 0.0
        normals = (-1.0 if inside_out else 1.0) * blended_normals(vertices, triangles)
        return Part(vertices, normals, triangles, colour)

    def moved(self, pose: FloatArray) -> "Part":
        """Return the mesh in the frame to which a pose leads, shape (4, 4)."""
        turned = self.normals @ pose[:3, :3].T
        return Part(self.vertices @ pose[:3, :3].T + pose[:3, 3], turned, self.triangles, self.colour)


_CLOSED = 100
"""A robot's meshes of more triangles are taken to be closed, so that they can be inside out."""


class ScenePainter:
    """Paints a robot at its table, and cloth."""

    def __init__(self, card: RobotCard, scene: Scene, palette: Palette) -> None:
        """Read the robot's meshes; some seconds for the first picture of a robot."""
        self._links = [
            (
                link,
                [
                    (
                        one.pose.matrix,
                        Part.of(
                            one.vertices,
                            one.triangles,
                            link_colour(link.name, palette),
                            is_closed=len(one.triangles) > _CLOSED,
                        ),
                    )
                    for one in link.visuals
                ],
            )
            for link in load_robot_model(card.urdf_path, card.package_dir)
        ]
        self._floor_z_m, self._palette = -scene.table.height_m, palette
        self._table = [
            Part.of(
                _CORNERS * part.size + part.center,
                np.arange(len(_CORNERS)).reshape(-1, 3),
                palette.table_foot if "leg" in part.name else palette.table,
            )
            for part in table_parts(scene.table)
        ]

    def picture(self, frame: Sample, layer_m: float, seen: Viewpoint, size_px: tuple[int, int]) -> Image.Image:
        """Return a sample of a plan from a viewpoint.

        Args:
            frame: the sample.
            layer_m: the height that a layer of the cloth takes (m).
            seen: the viewpoint.
            size_px: the picture's width and height.
        """
        wide, high = size_px
        lens = _Lens(seen, (_FINER * wide, _FINER * high))
        cloth = ThickCloth(frame.cloth, layer_m)
        parts = [*self._table, *self._cloth(cloth), *self._robot(frame.base, frame.joints)]
        starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
        vertices = np.concatenate([part.vertices for part in parts])
        triangles = np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)])
        lights = _brightness(np.concatenate([part.normals for part in parts]))
        projected = lens.project(vertices)
        numbers, brightness = nearest(*projected, lights, triangles, lens.size_px)
        counts = [len(part.triangles) for part in parts]
        table = sum(counts[: len(self._table)])
        coarse = _Lens(seen, (wide // _COARSER, high // _COARSER))
        fades = 1.0 + (_BEYOND - 1.0) * np.clip(coarse.ground_distances(self._floor_z_m) / _FAR_M, 0.0, 1.0)
        on_floor = fades * coarse.lit(vertices, triangles, self._floor_z_m)
        on_top = coarse.lit(vertices, triangles[table:], 0.0)
        is_floor, is_top = numbers < 0, (numbers >= 0) & (numbers < counts[0])
        brightness = np.where(is_floor, _resized(on_floor, lens.size_px), brightness)
        brightness = np.where(is_top, _resized(on_top, lens.size_px) * brightness, brightness)
        is_cloth = (numbers >= table) & (numbers < table + 2 * len(cloth.triangles))
        corners = triangles[numbers[is_cloth]]
        shares, depths = _within(np.argwhere(is_cloth)[:, ::-1].astype(float), *(part[corners] for part in projected))
        pattern = np.concatenate([cloth.pattern] * 2)[corners - starts[len(self._table)]]
        brightness[is_cloth] *= woven((shares[..., None] * pattern).sum(axis=1), depths / lens.focal_px)
        colours = np.array([*(part.colour for part in parts), self._palette.floor], np.float32)
        painted = np.repeat(colours, [*counts, 1], axis=0)[numbers] * brightness[..., None]  # the floor's is the last
        return Image.fromarray(np.clip(painted, 0, 255).astype(np.uint8)).reduce(_FINER)

    def _cloth(self, thick: ThickCloth) -> list[Part]:
        (front, back), faces = thick.faces, thick.triangles
        palette = self._palette
        return [
            Part.of(front, faces, palette.cloth_front),
            Part.of(back, faces[:, ::-1], palette.cloth_back),
            Part.of(*thick.hem, palette.cloth_hem),
        ]

    def _robot(self, base: Pose2, joints: dict[str, float]) -> Iterator[Part]:
        frames = {"": Pose3((base.x_m, base.y_m, self._floor_z_m), yaw(base.yaw_rad)).matrix}
        for link, parts in self._links:
            own = frames[link.node.rpartition("/")[0]] @ link.pose_at(joints.get(link.joint or "", 0.0)).matrix
            frames[link.node] = own
            for pose, part in parts:
                yield part.moved(own @ pose)


class _Lens:
    """A pinhole camera; up in its picture is up in the world."""

    def __init__(self, seen: Viewpoint, size_px: tuple[int, int]) -> None:
        self.position, self.size_px = np.array(seen.position), size_px
        ahead = np.array(seen.look_at) - self.position
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        self._axes = np.stack([right, np.cross(ahead, right), ahead])
        self.focal_px = size_px[1] / 2.0 / math.tan(seen.fov_rad / 2.0)

    def project(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return where points are in the picture, shape (n, 2), and how far ahead of the lens, shape (n,), m."""
        there = (points - self.position) @ self._axes.T
        ahead = np.where(np.abs(there[:, 2:]) > 1e-6, there[:, 2:], 1e-6)
        return self.focal_px * there[:, :2] / ahead + np.array(self.size_px) / 2.0, there[:, 2]

    def lit(self, vertices: FloatArray, triangles: Triangles, z_m: float) -> FloatArray:
        """Return how much light a level has where triangles keep the sun from it, shape (height, width), 1 at most."""
        fallen = vertices - np.maximum(vertices[:, 2:] - z_m, 0.0) * _SUN
        is_above = vertices[:, 2][triangles].max(axis=1) > z_m
        numbers, _ = nearest(*self.project(fallen), fallen[:, 0], triangles[is_above], self.size_px)
        mask = Image.fromarray((numbers >= 0).astype(np.uint8) * 255).filter(ImageFilter.GaussianBlur(_BLUR_PX))
        return np.asarray(1.0 - _SHADOW / 255.0 * np.asarray(mask, float))

    def ground_distances(self, z_m: float) -> FloatArray:
        """Return how far from the table's middle each pixel meets a level, shape (height, width), m; inf above it."""
        width, height = self.size_px
        x = (np.arange(width) - width / 2.0) / self.focal_px
        y = (np.arange(height)[:, None] - height / 2.0) / self.focal_px
        rays = x[None, :, None] * self._axes[0] + y[..., None] * self._axes[1] + self._axes[2]
        with np.errstate(divide="ignore"):
            share = (z_m - self.position[2]) / rays[..., 2]
        met = self.position[:2] + share[..., None] * rays[..., :2]
        return np.where(share > 0.0, np.hypot(met[..., 0], met[..., 1]), np.inf)


def _brightness(normals: FloatArray) -> FloatArray:
    """Return how bright surfaces are by their normals, shape (n, 3) -> (n,): about 1 for level ones."""
    light = _SKY * (0.75 + 0.25 * normals[:, 2])
    for towards, share in _LAMPS:
        light += share * np.maximum(normals @ (towards / np.linalg.norm(towards)), 0.0)
    return np.asarray(light / _LEVEL)


def _within(pixels: FloatArray, corners: FloatArray, depths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return what share each corner has in the place of a triangle that a pixel shows, and how far ahead that is (m).

    Args:
        pixels: the pixels, shape (n, 2).
        corners: where the triangles' corners are in the picture, shape (n, 3, 2).
        depths: how far ahead of the lens they are, shape (n, 3), m.
    """
    (ax, ay), (bx, by), (px, py) = ((end - corners[:, 0]).T for end in (corners[:, 1], corners[:, 2], pixels))
    area = ax * by - ay * bx
    second, third = (px * by - py * bx) / area, (ax * py - ay * px) / area
    near = np.stack([1.0 - second - third, second, third], axis=1) / depths  # 1 / depth is linear in the picture
    whole = near.sum(axis=1)
    return near / whole[:, None], 1.0 / whole


def _resized(plane: FloatArray, size_px: tuple[int, int]) -> NDArray[np.float32]:
    """Return a picture of one number a pixel at another size."""
    return np.asarray(Image.fromarray(plane.astype(np.float32)).resize(size_px, Image.Resampling.BILINEAR))
