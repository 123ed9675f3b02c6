"""Builds a binary glTF 2.0 file: nodes with meshes, and one animation of them.

glTF's quaternions have w last, its colours are shares of light, and an animation moves one property of one node between
keyframes. Whatever is given as an array here is in its numbers and its order.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pygltflib import (
    ELEMENT_ARRAY_BUFFER,
    FLOAT,
    GLTF2,
    UNSIGNED_INT,
    Accessor,
    Animation,
    AnimationChannel,
    AnimationChannelTarget,
    AnimationSampler,
    Asset,
    Attributes,
    Buffer,
    BufferView,
    Material,
    Mesh,
    Node,
    PbrMetallicRoughness,
    Primitive,
    Scene,
)

from planner.geometry.pose import FloatArray

_KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_ROUGHNESS = 0.8


class GltfWriter:
    """A glTF file being built."""

    def __init__(self, title: str) -> None:
        """Begin a file with an empty scene and an animation without channels."""
        self._data = bytearray()
        self._gltf = GLTF2(asset=Asset(generator="Pleat"), scene=0, scenes=[Scene(name=title, nodes=[])])
        self._animation = Animation(name=title)
        self._gltf.animations.append(self._animation)

    def numbers(self, values: FloatArray, *, is_bounded: bool = False) -> int:
        """Store numbers, shape (n,), (n, 3) or (n, 4), and return their accessor.

        Args:
            values: the numbers; stored in single precision.
            is_bounded: whether their least and greatest are told, as glTF asks of positions and of times.
        """
        stored = np.ascontiguousarray(values, dtype=np.float32)
        rows = stored.reshape(len(stored), -1)
        accessor = Accessor(bufferView=self._view(stored, None), componentType=FLOAT, count=len(rows))
        accessor.type = _KINDS[rows.shape[1]]
        if is_bounded:
            accessor.min, accessor.max = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        return self._add(self._gltf.accessors, accessor)

    def indices(self, triangles: NDArray[np.int64]) -> int:
        """Store triangles, shape (n, 3), and return their accessor."""
        stored = np.ascontiguousarray(triangles.reshape(-1), dtype=np.uint32)
        view = self._view(stored, ELEMENT_ARRAY_BUFFER)
        accessor = Accessor(bufferView=view, componentType=UNSIGNED_INT, count=len(stored), type="SCALAR")
        return self._add(self._gltf.accessors, accessor)

    def material(self, name: str, rgb: tuple[int, int, int]) -> int:
        """Add a dull material of a colour (screen values, 0..255) and return it."""
        screen = np.array(rgb) / 255.0
        light = np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4)
        surface = PbrMetallicRoughness(
            baseColorFactor=[*light.tolist(), 1.0], metallicFactor=0.0, roughnessFactor=_ROUGHNESS
        )
        return self._add(self._gltf.materials, Material(name=name, pbrMetallicRoughness=surface, alphaMode="OPAQUE"))

    def mesh(self, parts: Sequence[Primitive]) -> int:
        """Add a mesh of parts and return it."""
        return self._add(self._gltf.meshes, Mesh(primitives=list(parts)))

    @staticmethod
    def part(positions: int, indices: int, material: int, normals: int | None = None) -> Primitive:
        """Return a part of a mesh; without normals it is shaded flat."""
        return Primitive(attributes=Attributes(POSITION=positions, NORMAL=normals), indices=indices, material=material)

    def node(
        self,
        name: str,
        parent: int | None,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        wxyz: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
        scale: Sequence[float] = (1.0, 1.0, 1.0),
        mesh: int | None = None,
    ) -> int:
        """Add a node below another, or to the scene, and return it."""
        w, x, y, z = wxyz
        made = Node(name=name, translation=list(position), rotation=[x, y, z, w], scale=list(scale), mesh=mesh)
        added = self._add(self._gltf.nodes, made)
        (self._gltf.scenes[0].nodes if parent is None else self._gltf.nodes[parent].children).append(added)
        return added

    def animate(self, node: int, path: str, times: int, values: int, interpolation: str = "LINEAR") -> None:
        """Let a node's `translation`, `rotation` or `scale` go through values at times, given as accessors."""
        sampler = self._add(
            self._animation.samplers, AnimationSampler(input=times, interpolation=interpolation, output=values)
        )
        target = AnimationChannelTarget(node=node, path=path)
        self._animation.channels.append(AnimationChannel(sampler=sampler, target=target))

    def file(self) -> bytes:
        """Return the file."""
        self._gltf.buffers = [Buffer(byteLength=len(self._data))]
        self._gltf.set_binary_blob(bytes(self._data))
        return b"".join(self._gltf.save_to_bytes())

    def _view(self, stored: NDArray[np.float32] | NDArray[np.uint32], target: int | None) -> int:
        """Append numbers, which all have four bytes, so that each view is aligned."""
        view = BufferView(buffer=0, byteOffset=len(self._data), byteLength=stored.nbytes, target=target)
        self._data += stored.tobytes()
        return self._add(self._gltf.bufferViews, view)

    @staticmethod
    def _add(things: list[object], thing: object) -> int:
        things.append(thing)
        return len(things) - 1
