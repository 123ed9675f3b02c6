"""Reads the meshes of a robot's links and makes them light enough to be sent to a browser."""

import functools
import math
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from planner.geometry.pose import FloatArray, Point3
from planner.robots.mesh_file import read_mesh_file

MOST_TRIANGLES = 4_000
"""The most triangles of one mesh; makers' meshes have up to some 100,000, which nobody sees from across a table."""

_CREASE_RAD = math.radians(40.0)


def read_mesh(path: str, scale: Point3) -> trimesh.Trimesh:
    """Return the mesh in a file, scaled along x, y and z, of at most `MOST_TRIANGLES` triangles.

    Arms of a pair, and robots that share an arm, have the same files: each is read once. The mesh must not be changed.
    """
    return _read(path, scale, Path(path).stat().st_mtime_ns)


@functools.lru_cache(maxsize=256)
def _read(path: str, scale: Point3, _: int) -> trimesh.Trimesh:
    mesh = read_mesh_file(Path(path))
    mesh.merge_vertices(merge_tex=True, merge_norm=True)  # else each triangle of many a file stands alone
    if len(mesh.faces) > MOST_TRIANGLES:
        mesh = mesh.simplify_quadric_decimation(face_count=MOST_TRIANGLES)
    mesh.apply_scale(scale)
    return mesh


def creased(mesh: trimesh.Trimesh) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return vertices, shape (n, 3), and triangles, shape (m, 3), with a vertex for each side of a sharp edge.

    Two triangles share a vertex if edges that are not sharp connect them around it. A renderer blends the normals of
    all triangles at a vertex, and so shades sharp edges as edges. `trimesh.graph.smooth_shade` does the same, in 95 s
    for the 8,778 triangles of a UR5e's foot.
    """
    blended = mesh.face_adjacency_angles < _CREASE_RAD
    sides, edges = mesh.face_adjacency[blended], mesh.face_adjacency_edges[blended]
    one, other = (_corners(mesh.faces, np.repeat(sides[:, [side]], 2, axis=1), edges) for side in (0, 1))
    size = mesh.faces.size
    joined = coo_array((np.ones(one.size, dtype=np.int8), (one.ravel(), other.ravel())), shape=(size, size))
    count, vertex_of = connected_components(joined, directed=False)
    vertices = np.empty((count, 3))
    vertices[vertex_of] = mesh.vertices[mesh.faces.ravel()]
    return vertices, vertex_of.reshape(-1, 3).astype(np.int64)


def _corners(faces: NDArray[np.int64], face: NDArray[np.int64], vertex: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the places of vertices among the corners of all faces, three for each face."""
    corner: NDArray[np.int64] = np.argmax(faces[face] == vertex[..., None], axis=-1)
    return 3 * face + corner
