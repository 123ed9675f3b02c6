"""A robot's links with a few points of each mesh: read once, and kept in the user's cache.

A camera sees hulls, for which some hundred points of a part are enough. To read and to lighten whole meshes takes a
process up to 8 s (a pair of SO-101), those kept take some milliseconds.
"""

import contextlib
import re
from dataclasses import replace
from functools import cache
from hashlib import blake2b
from json import dumps, loads
from pathlib import Path
from typing import Any

import numpy as np

from app.ui import robot_mesh, robot_model
from app.ui.robot_model import Link, Pose3, Visual, load_robot_model
from planner.geometry.pose import FloatArray
from planner.robots import mesh_file
from planner.robots.kept_arrays import kept
from planner.user_cache import cache_folder

_POINTS = 400
"""Vertices of a part that are kept at most, besides those furthest out along each axis."""

_MADE_BY = (robot_mesh, robot_model, mesh_file)
"""The modules that meshes are read by: another version of them reads anew."""


def light_links(urdf_path: Path, package_dir: Path, directory: Path | None = None) -> tuple[Link, ...]:
    """Return all links of a robot, parents before children, whose visuals are points without triangles.

    A cache that cannot be read is made again; a cache that cannot be written is ignored.

    Args:
        urdf_path: the URDF.
        package_dir: the folder that ``package://`` in its mesh paths stands for.
        directory: the cache directory; None: the platform's own.
    """
    path = (directory or cache_folder()) / "links" / f"{_digest(urdf_path, package_dir)}.npz"
    return kept(
        path,
        lambda arrays: _read(arrays["links"].tobytes(), arrays["points"], arrays["counts"]),
        lambda: tuple(_light(link) for link in load_robot_model(urdf_path, package_dir)),
        _arrays,
    )


def _light(link: Link) -> Link:
    visuals = (Visual(one.pose, _some(one.vertices), np.empty((0, 3), np.int64)) for one in link.visuals)
    return replace(link, visuals=tuple(visuals))


def _some(vertices: FloatArray) -> FloatArray:
    """Return some of a part's vertices, those at its ends among them, shape (n, 3), m."""
    ends = vertices[np.unique(np.concatenate([vertices.argmin(axis=0), vertices.argmax(axis=0)]))]
    return np.vstack([vertices[:: max(1, len(vertices) // _POINTS)], ends])


def _arrays(links: tuple[Link, ...]) -> dict[str, Any]:
    visuals = [one for link in links for one in link.visuals]
    return {
        "links": np.frombuffer(dumps([_described(link) for link in links]).encode(), np.uint8),
        "points": np.vstack([np.empty((0, 3)), *(one.vertices for one in visuals)]),
        "counts": np.array([len(one.vertices) for one in visuals], np.int64),
    }


def _described(link: Link) -> dict[str, Any]:
    described = {name: getattr(link, name) for name in Link.__slots__}
    poses = {"origin": _pose_described(link.origin), "visuals": [_pose_described(one.pose) for one in link.visuals]}
    return described | poses | {"axis": link.axis.tolist()}


def _pose_described(pose: Pose3) -> list[float]:
    return [float(number) for number in (*pose.position, *pose.wxyz)]


def _read(described: bytes, points: FloatArray, counts: FloatArray) -> tuple[Link, ...]:
    parts = iter(np.split(points, np.cumsum(counts)[:-1]) if len(counts) else [])
    return tuple(_link(one, parts) for one in loads(described))


def _link(described: dict[str, Any], parts: Any) -> Link:  # noqa: ANN401
    poses = [_pose(numbers) for numbers in described["visuals"]]
    visuals = tuple(Visual(pose, next(parts), np.empty((0, 3), np.int64)) for pose in poses)
    return Link(
        **described | {"origin": _pose(described["origin"]), "axis": np.array(described["axis"]), "visuals": visuals}
    )


def _pose(numbers: list[float]) -> Pose3:
    x, y, z, *wxyz = numbers
    w, i, j, k = wxyz
    return Pose3((x, y, z), (w, i, j, k))


def _digest(urdf_path: Path, package_dir: Path) -> str:
    """Return a digest of what the links depend on: the URDF, its meshes, and how they are read."""
    urdf = urdf_path.read_bytes()
    digest = blake2b(f"{_POINTS} {_code()}".encode() + urdf, digest_size=12)
    for name in sorted(set(re.findall(rb'filename\s*=\s*["\']([^"\']+)', urdf))):
        path = package_dir / name.decode(errors="replace").removeprefix("package://")
        with contextlib.suppress(OSError, ValueError):
            digest.update(blake2b(path.read_bytes()).digest())
    return digest.hexdigest()


@cache
def _code() -> str:
    return " ".join(blake2b(Path(one.__file__ or "").read_bytes()).hexdigest() for one in _MADE_BY)
