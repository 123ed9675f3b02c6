"""The convex shape of every part of the PR2, made once from the meshes and kept in the user's cache directory."""

import contextlib
from collections.abc import Mapping
from hashlib import blake2b
from importlib.metadata import version
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from planner.robots.card import GripperCard
from planner.robots.collision.rounded_hull import RoundedHull, rounded_hull
from planner.robots.collision.shape_files import hull_arrays, hull_from, write_arrays
from planner.robots.openings import EDGE_OPEN_M, HELD_M
from planner.robots.pr2.description import urdf_path
from planner.robots.pr2.part_points import arm_points, body_points, finger_points, points_of_joints
from planner.robots.pr2.parts import ARM_PARTS, BODY_PARTS, FINGERS, FINGERTIPS
from planner.user_cache import cache_folder, use

OPENINGS_M = (0.0, HELD_M, EDGE_OPEN_M, 0.03, 0.06, 0.09)
"""Openings of the fingers for which there are shapes (m)."""

ROUNDING_MAX_M, TIPS_ROUNDING_MAX_M, EDGE_ROUNDING_MAX_M = 0.003, 0.0003, 0.0001
"""Limits on how far a shape may exceed the hull of its meshes, apart from being made symmetric (m).

Fingertips have a tighter limit because they pass the table's top by half a millimetre, and the tightest where they are
open so little that one may be under cloth.
"""

_FORMAT = 1
"""Version of the cache; raise it whenever shapes are made or stored differently."""

PartShapes = Mapping[str, RoundedHull]
"""Shapes by part name, an arm's as those of the left arm; see `finger_key` for fingers."""


def finger_key(part: int, opening_m: float) -> str:
    """Return the name of the shape of fingers or fingertips that may be open up to a width (m)."""
    level = next((level for level in OPENINGS_M if opening_m <= level), OPENINGS_M[-1])
    return f"{ARM_PARTS[part].name} {round(1000 * level)}"


def part_shapes(model: pin.Model, gripper: GripperCard, directory: Path | None = None) -> PartShapes:
    """Return the shapes, read from the cache or made (in a second) and cached.

    A cache that cannot be read is made again; a cache that cannot be written is ignored.

    Args:
        model: the kinematic tree.
        gripper: how the fingers open.
        directory: the cache directory; None: the platform's own.
    """
    path = (directory or cache_folder()) / "shapes" / f"pr2-{_digest()}.npz"
    try:
        found = _read(path)
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        found = make_shapes(model, gripper)
        with contextlib.suppress(OSError):
            _write(path, found)
    with contextlib.suppress(OSError):
        use(path)
    return found


def make_shapes(model: pin.Model, gripper: GripperCard) -> PartShapes:
    """Return the shapes, made from the meshes."""
    points = points_of_joints(model)
    body = dict(zip((part.name for part in BODY_PARTS), body_points(points), strict=True))
    arm = dict(zip((part.name for part in ARM_PARTS[:FINGERS]), arm_points(points), strict=True))
    for opening_m in OPENINGS_M:
        fingers = finger_points(model, points, gripper, opening_m)
        arm |= zip((finger_key(part, opening_m) for part in (FINGERS, FINGERTIPS)), fingers, strict=True)
    shapes = {name: rounded_hull(cloud, ROUNDING_MAX_M, is_symmetric=True) for name, cloud in body.items()}
    most = dict.fromkeys(arm, ROUNDING_MAX_M)
    for opening_m in OPENINGS_M:
        tips_m = TIPS_ROUNDING_MAX_M if opening_m > EDGE_OPEN_M else EDGE_ROUNDING_MAX_M
        most[finger_key(FINGERTIPS, opening_m)] = tips_m
    return shapes | {name: rounded_hull(cloud, most[name]) for name, cloud in arm.items()}


def _digest() -> str:
    """Return a digest of everything that the shapes depend on."""
    digest = blake2b(
        f"{_FORMAT} {version('example-robot-data')} {ROUNDING_MAX_M} {TIPS_ROUNDING_MAX_M} "
        f"{EDGE_ROUNDING_MAX_M} {OPENINGS_M}".encode(),
        digest_size=8,
    )
    meshes = sorted(urdf_path().parent.parent.rglob("*.stl"))
    for path in (urdf_path(), *meshes):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _names() -> list[str]:
    fingers = [finger_key(part, opening_m) for opening_m in OPENINGS_M for part in (FINGERS, FINGERTIPS)]
    return [part.name for part in (*BODY_PARTS, *ARM_PARTS[:FINGERS])] + fingers


def _read(path: Path) -> PartShapes:
    """Return the shapes in a file; raise one of several errors where they are missing or malformed."""
    with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
        return {name: hull_from(arrays, name) for name in _names()}


def _write(path: Path, shapes: PartShapes) -> None:
    arrays: dict[str, NDArray[Any]] = {}
    for name, shape in shapes.items():
        arrays |= hull_arrays(name, shape)
    write_arrays(path, arrays)
