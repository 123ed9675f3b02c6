"""A checker of FOLD files against the specification, version 1.2, independent of the exporter.

It checks keys and lists as the specification has them; the mesh hangs together and is oriented; every frame
moves every face rigidly; mountains, valleys and flat creases are where the faces say; the order of faces covers
exactly those that overlap, contradicts neither itself nor the creases.
"""

import math
from itertools import combinations
from typing import Any

import numpy as np
import shapely

FILE_CLASSES = {"singleModel", "multiModel", "animation", "diagrams"}
FRAME_CLASSES = {"creasePattern", "foldedForm", "graph", "linkage"}
FRAME_KEYS = {
    "frame_title",
    "frame_classes",
    "frame_attributes",
    "frame_unit",
    "frame_parent",
    "frame_inherit",
    "vertices_coords",
    "edges_vertices",
    "edges_assignment",
    "edges_foldAngle",
    "faces_vertices",
    "faceOrders",
}
FILE_KEYS = FRAME_KEYS | {"file_spec", "file_creator", "file_title", "file_classes", "file_frames"}
NEAR_M = 1e-4
SLIVER_M2 = 2e-5


def frames_of(file: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the key frame and all others, with inherited fields filled in."""
    key = {name: value for name, value in file.items() if not name.startswith("file_")}
    frames = [key]
    for frame in file["file_frames"]:
        parent = frames[frame["frame_parent"]] if frame.get("frame_inherit") else {}
        frames.append({**parent, **frame})
    return frames


def require_valid(file: dict[str, Any]) -> None:
    assert file["file_spec"] == 1.2
    assert set(file) <= FILE_KEYS
    assert set(file["file_classes"]) <= FILE_CLASSES
    for frame in file["file_frames"]:
        assert set(frame) <= FRAME_KEYS
    frames = frames_of(file)
    for frame in frames:
        assert set(frame["frame_classes"]) <= FRAME_CLASSES
        require_mesh(frame)
        require_creases(frame)
        require_rigid(frames[0], frame)
    for frame in frames[1:]:
        require_orders(frame)
    for face in rings(frames[0]):
        assert signed_area(face) > 0.0, "faces are counter-clockwise in the crease pattern"


def rings(frame: dict[str, Any]) -> list[np.ndarray]:
    places = np.array(frame["vertices_coords"])
    return [places[face] for face in frame["faces_vertices"]]


def signed_area(ring: np.ndarray) -> float:
    doubled: float = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True))
    return doubled / 2


def sides(frame: dict[str, Any]) -> dict[tuple[int, int], int]:
    """Return each directed side of a face, and the face."""
    found = {}
    for number, face in enumerate(frame["faces_vertices"]):
        assert len(set(face)) == len(face) >= 3
        for side in zip(face, [*face[1:], face[0]], strict=True):
            assert side not in found, "two faces run along one edge in the same direction"
            found[side] = number
    return found


def require_mesh(frame: dict[str, Any]) -> None:
    count = len(frame["vertices_coords"])
    assert all(len(place) == 2 and all(math.isfinite(value) for value in place) for place in frame["vertices_coords"])
    assert all(0 <= vertex < count for face in frame["faces_vertices"] for vertex in face)
    edges = [tuple(sorted(edge)) for edge in frame["edges_vertices"]]
    assert len(set(edges)) == len(edges)
    assert set(edges) == {tuple(sorted(side)) for side in sides(frame)}
    assert len(frame["edges_assignment"]) == len(frame["edges_foldAngle"]) == len(edges)


def faces_at(frame: dict[str, Any], edge: list[int]) -> list[int]:
    a, b = edge
    found = sides(frame)
    return [found[side] for side in ((a, b), (b, a)) if side in found]


def require_creases(frame: dict[str, Any]) -> None:
    is_folded = frame["frame_classes"] == ["foldedForm"]
    turned = [signed_area(ring) < 0.0 for ring in rings(frame)]
    angles = {"B": 0, "F": 0, "M": -180, "V": 180}
    for edge, kind, angle in zip(
        frame["edges_vertices"], frame["edges_assignment"], frame["edges_foldAngle"], strict=True
    ):
        faces = faces_at(frame, edge)
        assert (kind == "B") == (len(faces) == 1)
        assert angle == angles[kind]
        if is_folded and len(faces) == 2:
            assert (kind == "F") == (turned[faces[0]] == turned[faces[1]])


def require_rigid(key: dict[str, Any], frame: dict[str, Any]) -> None:
    for flat, carried in zip(rings(key), rings(frame), strict=True):
        for i, j in combinations(range(len(flat)), 2):
            assert abs(math.dist(flat[i], flat[j]) - math.dist(carried[i], carried[j])) < NEAR_M


def require_orders(frame: dict[str, Any]) -> None:
    faces = [shapely.Polygon(ring) for ring in rings(frame)]
    turned = [signed_area(ring) < 0.0 for ring in rings(frame)]
    above: set[tuple[int, int]] = set()
    for f, g, s in frame["faceOrders"]:
        assert s in (1, -1)
        above.add((f, g) if (s == 1) != turned[g] else (g, f))
    overlapping = {
        (f, g)
        for f, g in combinations(range(len(faces)), 2)
        if shapely.intersection(faces[f], faces[g]).area > SLIVER_M2
    }
    assert {tuple(sorted(pair)) for pair in above} >= overlapping
    assert not any((g, f) in above for f, g in above)
    for edge, kind in zip(frame["edges_vertices"], frame["edges_assignment"], strict=True):
        if kind in "MV":
            f, g = faces_at(frame, edge)
            # A valley has each face on the side to which the other's normal points.
            is_f_above = (f, g) in above
            if is_f_above or (g, f) in above:
                assert (kind == "V") == (is_f_above != turned[g])
    require_no_circle(above, len(faces))


def require_no_circle(above: set[tuple[int, int]], count: int) -> None:
    left = set(range(count))
    while left:
        tops = {face for face in left if not any(g == face and f in left for f, g in above)}
        assert tops, "faces lie above one another in a circle"
        left -= tops
