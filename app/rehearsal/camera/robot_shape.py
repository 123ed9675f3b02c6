"""The shape of a robot for its camera: the hull of each part of its links."""

from collections.abc import Iterator, Mapping
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.light_links import light_links
from app.rehearsal.camera.posture import Posture
from app.ui.robot_model import Link, Pose3
from app.ui.rotation import yaw
from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.card import RobotCard

_WRIST_JOINTS = 2
"""The last joints of an arm, which carry its hand."""


class RobotShape:
    """The parts of a robot's links, each as some of its points."""

    def __init__(self, links: tuple[Link, ...], floor_z_m: float, wrists: Mapping[str, str]) -> None:
        """Take the links, parents first, the floor's height, and which joints carry hands.

        Args:
            links: the links.
            floor_z_m: the floor's height in the table frame (m), negative.
            wrists: the names of hands by the joints beyond which all links belong to them.
        """
        self._links, self._floor_z_m = links, floor_z_m
        self._owners: dict[str, str] = {"": ""}
        for link in links:
            parent = self._owners[link.node.rpartition("/")[0]]
            self._owners[link.node] = parent or wrists.get(link.joint or "", "")
        self._parts = [[one.pose.matrix @ _homogeneous(one.vertices).T for one in link.visuals] for link in links]

    def frames(self, posture: Posture) -> dict[str, FloatArray]:
        """Return the pose of each link in the table frame by its name, shape (4, 4)."""
        base = posture.base
        root = Pose3((base.x_m, base.y_m, self._floor_z_m), yaw(base.yaw_rad)).matrix
        nodes: dict[str, FloatArray] = {"": root}
        for link in self._links:
            here = link.pose_at(posture.joints.get(link.joint or "", 0.0)).matrix
            nodes[link.node] = nodes[link.node.rpartition("/")[0]] @ here
        return {link.name: nodes[link.node] for link in self._links}

    def parts(self, posture: Posture) -> list[FloatArray]:
        """Return the points of each part, table frame, shape (n, 3), m."""
        return [part for _, part in self._placed(posture)]

    def hands(self, posture: Posture) -> dict[str, list[FloatArray]]:
        """Return the points of the parts of each hand, and of all others as "", table frame, shape (n, 3), m."""
        found: dict[str, list[FloatArray]] = {name: [] for name in self._owners.values()}
        for owner, part in self._placed(posture):
            found[owner].append(part)
        return found

    def _placed(self, posture: Posture) -> Iterator[tuple[str, FloatArray]]:
        """Yield each part's hand, "" if it is of none, and its points."""
        frames = self.frames(posture)
        for link, parts in zip(self._links, self._parts, strict=True):
            for part in parts:
                yield self._owners[link.node], np.asarray((frames[link.name] @ part)[:3].T)


@lru_cache(maxsize=4)
def robot_shape(card: RobotCard, floor_z_m: float) -> RobotShape:
    """Return the shape of a robot on a floor (m, negative); the same one until its URDF changes."""
    wrists = {arm.joint_names[-_WRIST_JOINTS]: arm.name for arm in card.arms}
    return RobotShape(light_links(card.urdf_path, card.package_dir), floor_z_m, wrists)


def rising(parts: list[FloatArray], camera: Camera) -> list[FloatArray]:
    """Return the points above the table of each part in front of the camera, shape (n, 3), m; the highest part last."""
    above = [part[part[:, 2] > 0.0] for part in parts]
    seen = [part for part in above if len(part) > 2 and float(camera.depths(part).min()) > 0.0]
    return sorted(seen, key=lambda part: float(part[:, 2].mean()))


def outlines(parts: list[FloatArray], camera: Camera) -> list[NDArray[np.int32]]:
    """Return the convex outline of each part that rises over the table, shape (k, 2), pixels, the highest last."""
    return [_hull(camera.pixels(part)) for part in rising(parts, camera)]


def hidden(parts: list[FloatArray], camera: Camera, beyond_px: int = 0) -> BoolArray:
    """Return which pixels show the robot or lie within a margin round it (pixels), shape (height, width)."""
    import cv2  # here, because only pictures need it

    width, height = camera.size_px
    mask: NDArray[np.uint8] = np.zeros((height, width), np.uint8)
    for ring in outlines(parts, camera):
        cv2.fillConvexPoly(mask, ring, 1)
    wide = np.ones((2 * beyond_px + 1, 2 * beyond_px + 1), np.uint8)
    return np.asarray(cv2.dilate(mask, wide) > 0)


def _hull(pixels: FloatArray) -> NDArray[np.int32]:
    import cv2

    return np.asarray(cv2.convexHull(np.round(pixels).astype(np.int32))[:, 0], np.int32)


def _homogeneous(vertices: FloatArray) -> FloatArray:
    return np.column_stack([vertices, np.ones(len(vertices))])
