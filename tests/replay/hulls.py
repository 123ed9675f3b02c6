"""An independent check of collisions: the convex hulls of the robot's full meshes, posed by yourdfpy.

Nothing of `planner.robots` is used. Every link is the hull of all that the URDF has for it, shown or for collisions.
Links are compared unless nothing moves between them; one carries the other over no more than three joints (such
neighbours are hollow round each other, and their hulls overlap where they do not); or both are of one gripper.
All are compared with all of the table. Lengths in m.
"""

from dataclasses import dataclass
from functools import cache
from importlib.metadata import distribution
from itertools import combinations
from typing import Any

import coal
import numpy as np
import trimesh
import yourdfpy

from planner.geometry.table import Table, table_parts

SHARE = "cmeel.prefix/share"
URDF = f"{SHARE}/example-robot-data/robots/pr2_description/urdf/pr2.urdf"
CARRIED_OVER = 3


@dataclass(frozen=True)
class Body:
    """A link or a box: its hull for coal, and the sphere that holds it, in the link's frame."""

    name: str
    shape: Any
    middle: np.ndarray
    radius_m: float


@cache
def robot() -> yourdfpy.URDF:
    path = distribution("example-robot-data").locate_file(URDF)
    return yourdfpy.URDF.load(str(path), filename_handler=mesh_path, load_meshes=False)


def mesh_path(fname: str) -> str:
    return fname.replace("package://", f"{distribution('example-robot-data').locate_file(SHARE)}/")


def link_vertices(name: str) -> np.ndarray:
    """Return all vertices of a link's meshes, and the corners of its other shapes, in its frame, shape (n, 3)."""
    link = robot().link_map[name]
    found = [np.empty((0, 3))]
    for one in (*link.visuals, *link.collisions):
        found.append(trimesh.transform_points(_vertices(one.geometry), np.eye(4) if one.origin is None else one.origin))
    return np.vstack(found)


def _vertices(geometry: yourdfpy.Geometry) -> np.ndarray:
    if geometry.mesh is not None:
        scale = 1.0 if geometry.mesh.scale is None else geometry.mesh.scale
        mesh = trimesh.load(mesh_path(geometry.mesh.filename), force="mesh")
        assert isinstance(mesh, trimesh.Trimesh)
        return np.asarray(np.asarray(mesh.vertices) * scale)
    if geometry.box is not None:
        return np.asarray(trimesh.creation.box(geometry.box.size).vertices)
    return np.asarray(trimesh.creation.cylinder(geometry.cylinder.radius, geometry.cylinder.length).vertices)


def body(name: str, vertices: np.ndarray) -> Body:
    hull = trimesh.Trimesh(vertices).convex_hull
    points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for vertex in hull.vertices:
        points.append(vertex)
    for face in hull.faces.tolist():
        triangles.append(coal.Triangle(*face))
    middle = hull.bounds.mean(axis=0)
    radius_m = float(np.linalg.norm(hull.vertices - middle, axis=1).max())
    return Body(name, coal.Convex(points, triangles), middle, radius_m)


@cache
def bodies() -> tuple[Body, ...]:
    """Return all links that have a shape."""
    clouds = {name: link_vertices(name) for name in robot().link_map}
    return tuple(body(name, cloud) for name, cloud in clouds.items() if len(cloud))


def moving_joints(link: str) -> tuple[str, ...]:
    """Return the joints that move a link, the base's first."""
    joint_to = {joint.child: joint for joint in robot().joint_map.values()}
    found: list[str] = []
    while link in joint_to:
        if joint_to[link].type != "fixed":
            found.append(joint_to[link].name)
        link = joint_to[link].parent
    return tuple(reversed(found))


def are_compared(a: str, b: str) -> bool:
    """Return whether two links are checked for overlap."""
    to_a, to_b = moving_joints(a), moving_joints(b)
    shared = sum(one == other for one, other in zip(to_a, to_b, strict=False))
    between = len(to_a) + len(to_b) - 2 * shared
    carries = shared == min(len(to_a), len(to_b))
    same_hand = any(joint.endswith("wrist_roll_joint") for joint in to_a[:shared])
    return not same_hand and not (carries and between <= CARRIED_OVER)


@cache
def pairs() -> np.ndarray:
    """Return the indices of the links to check against each other, shape (n, 2)."""
    names = [one.name for one in bodies()]
    return np.array([(i, j) for i, j in combinations(range(len(names)), 2) if are_compared(names[i], names[j])])


def contacts(joints: dict[str, float], base: tuple[float, float, float], table: Table) -> list[tuple[str, str, float]]:
    """Return the collisions in one posture.

    Args:
        joints: every actuated joint by name, the torso's and the grippers' among them (rad, m).
        base: where the robot's base stands in the table frame: x, y (m) and yaw (rad).
        table: the table.

    Returns:
        Two links, or a link and a part of the table, and how deep they are in each other (m), deepest first.
    """
    robot().update_cfg(joints)
    links = bodies()
    poses = np.array([robot().get_transform(one.name) for one in links])
    middles = np.einsum("nij,nj->ni", poses[:, :3, :3], [one.middle for one in links]) + poses[:, :3, 3]
    radii = np.array([one.radius_m for one in links])
    first, second = pairs().T
    near = np.linalg.norm(middles[first] - middles[second], axis=1) <= radii[first] + radii[second]
    found = [
        (links[i].name, links[j].name, _depth(links[i].shape, poses[i], links[j].shape, poses[j]))
        for i, j in pairs()[near]
    ]
    to_base = np.linalg.inv(trimesh.transformations.translation_matrix((*base[:2], -table.height_m)) @ _yaw(base[2]))
    for part in table_parts(table):
        pose = to_base @ trimesh.transformations.translation_matrix(part.center)
        outside = np.abs((middles - pose[:3, 3]) @ pose[:3, :3]) - np.array(part.size) / 2
        for i in np.flatnonzero((outside <= radii[:, None]).all(axis=1)):
            found.append((links[i].name, part.name, _depth(links[i].shape, poses[i], coal.Box(*part.size), pose)))
    return sorted((one for one in found if one[2] > 0.0), key=lambda one: -one[2])


def _yaw(angle: float) -> np.ndarray:
    return np.asarray(trimesh.transformations.rotation_matrix(angle, (0.0, 0.0, 1.0)))


def _depth(a: Any, pose_a: np.ndarray, b: Any, pose_b: np.ndarray) -> float:
    """Return the penetration depth of two convex shapes (m); not positive if they are apart."""
    at_a, at_b = (coal.Transform3s(pose[:3, :3], pose[:3, 3]) for pose in (pose_a, pose_b))
    return -float(coal.distance(a, at_a, b, at_b, coal.DistanceRequest(), coal.DistanceResult()))
