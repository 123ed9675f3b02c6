"""The cloth in the 3D view: its two faces in two colours, and the outline of every layer.

A face of cloth has no thickness, so it is drawn twice from the same triangles: one mesh is seen from the front, the
other from behind. Neither casts a shadow, because it would fall on the other. A third one, which nobody sees, casts it
from just below: cloth in the air shades the table and the cloth under it, and never itself.
"""

import numpy as np
import viser

from app.ui.colours import Palette
from app.ui.lighting import ink, paint
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.motion.sample import ClothSurface

ROOT = "/cloth"

_EDGE_PX = 1.5
_SHADE_M = (0.0, 0.0, -0.03)
"""Where the mesh that casts the shadow is, beside the cloth (m): lying cloth has it inside the table."""
_SIDES = np.array([[0, 1], [1, 2], [2, 0]])
_NO_POINTS = np.zeros((3, 3))
_NO_TRIANGLES = np.zeros((1, 3), dtype=np.int64)


class ClothView:
    """Shows one cloth surface at a time."""

    def __init__(self, scene: viser.SceneApi, root: str = ROOT) -> None:
        """Build the nodes ``front``, ``back``, ``shade`` and ``edges`` below a root, without cloth at first."""
        add_mesh = scene.add_mesh_simple
        self._front = add_mesh(f"{root}/front", _NO_POINTS, _NO_TRIANGLES, side="front", cast_shadow=False)
        self._back = add_mesh(f"{root}/back", _NO_POINTS, _NO_TRIANGLES, side="back", cast_shadow=False)
        self._shade = add_mesh(
            f"{root}/shade", _NO_POINTS, _NO_TRIANGLES, side="double", opacity=0.0, position=_SHADE_M
        )
        self._edges = scene.add_line_segments(
            f"{root}/edges",
            np.zeros((1, 2, 3)),
            (0, 0, 0),
            thickness=_EDGE_PX,
            thickness_units="screen",
        )
        self._shown: ClothSurface | None = None

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        self._front.color, self._back.color = paint(palette.cloth_front), paint(palette.cloth_back)
        self._edges.colors = ink(palette.cloth_edge)

    def set_visible(self, *, is_visible: bool) -> None:
        """Show or hide the cloth."""
        for node in (self._front, self._back, self._shade, self._edges):
            node.visible = is_visible

    def show(self, cloth: ClothSurface) -> None:
        """Replace the surface shown."""
        before, self._shown = self._shown, cloth
        if cloth is before:
            return
        is_recut = before is None or not np.array_equal(cloth.triangles, before.triangles)
        vertices = cloth.vertices.astype(np.float32)
        for mesh in (self._front, self._back, self._shade):
            mesh.vertices = vertices
            if is_recut:
                mesh.faces = cloth.triangles.astype(np.uint32)
        self._edges.points = outlines(cloth).astype(np.float32)


def outlines(cloth: ClothSurface) -> FloatArray:
    """Return the edges that no two triangles of a layer share, as segments, shape (n, 2, 3), m.

    Triangles need not share vertices: corners at the same place are the same corner.
    """
    corners = np.round(cloth.vertices[cloth.triangles] / LENGTH_M).astype(np.int64)
    layers = np.broadcast_to(cloth.layers[:, None, None], (*corners.shape[:2], 1))
    places = np.concatenate([corners, layers], axis=2)
    _, names = np.unique(places.reshape(-1, 4), axis=0, return_inverse=True)
    ends = names.reshape(-1, 3)[:, _SIDES].reshape(-1, 2)
    _, first, counts = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_counts=True)
    shown = cloth.triangles[:, _SIDES].reshape(-1, 2)[first[counts == 1]]
    return np.asarray(cloth.vertices[shown]) if len(shown) else np.zeros((1, 2, 3))
