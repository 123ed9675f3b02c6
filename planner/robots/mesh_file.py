"""Read a mesh's file, and no other: what it names, such as materials, textures and buffers, is not opened."""

from io import BytesIO
from pathlib import Path

import trimesh


class MeshError(ValueError):
    """A file that cannot be read as a mesh."""


def read_mesh_file(path: Path) -> trimesh.Trimesh:
    """Return the mesh in a file, its parts where their scene has them.

    Raises:
        MeshError: the file is no mesh of the format by whose name it ends.
        OSError: it cannot be read.
    """
    data = path.read_bytes()
    if b"<!DOCTYPE" in data[:10_000]:
        raise MeshError(f"{path.name} declares a document type, which could declare entities")
    try:
        # Given as bytes it has no folder, so that trimesh has nowhere to look for what it names.
        mesh = trimesh.load_mesh(BytesIO(data), file_type=path.suffix[1:].lower(), process=False)
        has_triangles = len(mesh.faces) > 0
    except Exception as error:  # readers of broken files raise whatever comes of it
        raise MeshError(f"{path.name} is no {path.suffix[1:].upper()} file: {type(error).__name__}") from None
    if not has_triangles:
        raise MeshError(f"{path.name} has no triangles")
    return mesh
