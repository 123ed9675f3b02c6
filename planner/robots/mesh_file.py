"""Read a mesh's file and nothing else: materials, textures and buffers that it names are not opened."""

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import trimesh

_STL_HEAD, _STL_TRIANGLE = 84, 50
"""Bytes before the triangles of a binary STL file, the last four of which are their number, and of each triangle."""


class MeshError(ValueError):
    """A file that cannot be read as a mesh."""


def read_mesh_file(path: Path) -> "trimesh.Trimesh":
    """Return the mesh in a file, its parts where their scene has them, without triangles that have no area.

    A COLLADA file's lengths are brought to metres by the unit that it declares. Which axis it calls up does not count:
    URDFs are made for programs that take its axes as they are.

    Raises:
        MeshError: the file is no mesh of the format by whose name it ends.
        OSError: it cannot be read.
    """
    import trimesh  # slow to import, and needed only where shapes are made
    from trimesh.units import unit_conversion

    data = path.read_bytes()
    if b"<!DOCTYPE" in data[:10_000]:
        raise MeshError(f"{path.name} declares a document type, which could declare entities")
    try:
        # Given as bytes it has no folder, so that trimesh has nowhere to look for what it names.
        kind = path.suffix[1:].lower()
        scene = trimesh.load_scene(BytesIO(data), file_type=kind, process=False)
        mesh: trimesh.Trimesh = scene.to_mesh()
        units = next((part.units for part in scene.geometry.values()), None)
        if kind == "dae" and units is not None:
            mesh.apply_scale(unit_conversion(units, "meters"))
        mesh.update_faces(mesh.area_faces != 0.0)
    except Exception as error:  # readers of broken files raise whatever comes of it
        raise MeshError(f"{path.name} is no {path.suffix[1:].upper()} file: {type(error).__name__}") from None
    if not len(mesh.faces):
        raise MeshError(f"{path.name} has no triangles")
    return mesh


def triangle_count(path: Path) -> int | None:
    """Return how many triangles a binary STL file has, from its head; None of other files; raise `OSError`."""
    if path.suffix.lower() != ".stl":
        return None
    with path.open("rb") as file:
        count = int.from_bytes(file.read(_STL_HEAD)[-4:], "little")
    return count if path.stat().st_size == _STL_HEAD + count * _STL_TRIANGLE else None
