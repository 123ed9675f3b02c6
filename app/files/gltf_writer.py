"""Builds a binary glTF 2.0 file: nodes with meshes, and one animation of them.

glTF's quaternions have w last, its colours are shares of light, and an animation moves one property of one node between
keyframes. Whatever is given as an array here is in its numbers and its order.
"""

import json
import struct
from collections.abc import Iterable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from app.files.scene_animation import AT_PARENT, FULL_SIZE, Moved
from app.ui.colours import Rgb, linear
from app.ui.robot_model import Pose3
from planner.geometry.pose import FloatArray, Point3

_KINDS: Final = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_FLOAT, _UNSIGNED_INT, _ELEMENT_ARRAY_BUFFER = 5126, 5125, 34963
_MAGIC, _VERSION, _JSON, _BIN = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
_ROUGHNESS = 0.8


class GltfWriter:
    """A glTF file being built."""

    def __init__(self, title: str) -> None:
        """Begin a file with an empty scene and an animation without channels."""
        self._data = bytearray()
        self._scene: dict[str, Any] = {"name": title, "nodes": []}
        self._animation: dict[str, Any] = {"name": title, "channels": [], "samplers": []}
        self._times: dict[bytes, int] = {}
        self._lists: dict[str, list[Any]] = {
            name: [] for name in ("accessors", "bufferViews", "materials", "meshes", "nodes")
        }

    def material(self, name: str, rgb: Rgb) -> int:
        """Add a dull material of a colour (screen values, 0..255) and return it."""
        factors = {"baseColorFactor": [*linear(rgb), 1.0], "metallicFactor": 0.0, "roughnessFactor": _ROUGHNESS}
        return self._add("materials", {"name": name, "pbrMetallicRoughness": factors})

    def mesh(
        self, vertices: FloatArray, triangles: NDArray[np.int64], material: int, normals: FloatArray | None = None
    ) -> int:
        """Add a mesh, shapes (n, 3), m, and (m, 3), and return it; without normals it is shaded flat."""
        attributes = {"POSITION": self._numbers(vertices, is_bounded=True)}
        if normals is not None:
            attributes["NORMAL"] = self._numbers(normals)
        return self._mesh([(attributes, triangles, material)])

    def two_sided(
        self, vertices: FloatArray, normals: FloatArray, triangles: NDArray[np.int64], front: int, back: int
    ) -> int:
        """Add a mesh that is seen from both sides, each in a material of its own, and return it."""
        places = self._numbers(vertices, is_bounded=True)
        sides = ((normals, triangles, front), (-normals, triangles[:, ::-1], back))
        return self._mesh(
            ({"POSITION": places, "NORMAL": self._numbers(facing)}, seen, material) for facing, seen, material in sides
        )

    def node(
        self, name: str, parent: int | None, pose: Pose3 = AT_PARENT, scale: Point3 = FULL_SIZE, mesh: int | None = None
    ) -> int:
        """Add a node below another, or to the scene, and return it."""
        w, x, y, z = pose.wxyz
        made = {"name": name, "translation": list(pose.position), "rotation": [x, y, z, w], "scale": list(scale)}
        added = self._add("nodes", made if mesh is None else made | {"mesh": mesh})
        above = self._scene if parent is None else self._lists["nodes"][parent]
        above.setdefault("nodes" if parent is None else "children", []).append(added)
        return added

    def animate(
        self, node: int, what: Moved, times_s: FloatArray, values: FloatArray, interpolation: str = "LINEAR"
    ) -> None:
        """Let a node's translation (m), rotation (x, y, z, w) or scale go through values, shape (n, 3 or 4)."""
        samplers = self._animation["samplers"]
        times = self._times.get(stored := times_s.tobytes())
        if times is None:
            times = self._times[stored] = self._numbers(times_s, is_bounded=True)
        samplers.append({"input": times, "interpolation": interpolation, "output": self._numbers(values)})
        channel = {"sampler": len(samplers) - 1, "target": {"node": node, "path": what}}
        self._animation["channels"].append(channel)

    def file(self) -> bytes:
        """Return the file."""
        content = {
            "asset": {"version": "2.0", "generator": "Pleat"},
            "scene": 0,
            "scenes": [self._scene],
            "animations": [self._animation] if self._animation["channels"] else [],
            "buffers": [{"byteLength": len(self._data)}],
            **self._lists,
        }
        # The format allows no empty lists.
        text = json.dumps({name: value for name, value in content.items() if value != []}).encode("ascii")
        chunks = b"".join(
            struct.pack("<II", len(chunk), kind) + chunk
            for kind, chunk in ((_JSON, text.ljust(-(-len(text) // 4) * 4)), (_BIN, bytes(self._data)))
        )
        return struct.pack("<III", _MAGIC, _VERSION, 12 + len(chunks)) + chunks

    def _mesh(self, parts: Iterable[tuple[dict[str, int], NDArray[np.int64], int]]) -> int:
        """Add a mesh of parts: attributes, triangles and material of each."""
        primitives = [
            {"attributes": attributes, "indices": self._indices(triangles), "material": material}
            for attributes, triangles, material in parts
        ]
        return self._add("meshes", {"primitives": primitives})

    def _numbers(self, values: FloatArray, *, is_bounded: bool = False) -> int:
        """Store numbers, shape (n,), (n, 3) or (n, 4), and return their accessor.

        Args:
            values: the numbers; stored in single precision.
            is_bounded: whether their least and greatest are written, as glTF requires of positions and of times.
        """
        stored = np.ascontiguousarray(values, dtype=np.float32)
        rows = stored.reshape(len(stored), -1)
        bounds = {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()} if is_bounded else {}
        return self._accessor(self._view(stored), _FLOAT, len(rows), _KINDS[rows.shape[1]], **bounds)

    def _indices(self, triangles: NDArray[np.int64]) -> int:
        """Store triangles, shape (n, 3), and return their accessor."""
        stored = np.ascontiguousarray(triangles.reshape(-1), dtype=np.uint32)
        view = self._view(stored, target=_ELEMENT_ARRAY_BUFFER)
        return self._accessor(view, _UNSIGNED_INT, len(stored), "SCALAR")

    def _view(self, stored: NDArray[np.float32] | NDArray[np.uint32], **target: int) -> int:
        """Append numbers, which all have four bytes, so that each view is aligned."""
        view = {"buffer": 0, "byteOffset": len(self._data), "byteLength": stored.nbytes, **target}
        self._data += stored.tobytes()
        return self._add("bufferViews", view)

    def _accessor(self, view: int, component: int, count: int, kind: str, **bounds: list[float]) -> int:
        return self._add(
            "accessors", {"bufferView": view, "componentType": component, "count": count, "type": kind, **bounds}
        )

    def _add(self, name: str, thing: dict[str, Any]) -> int:
        self._lists[name].append(thing)
        return len(self._lists[name]) - 1
