"""The cloth in the 3D view: two faces in two colours, as far apart as it is thick, a hem, the outline of each layer.

No face casts a shadow, because it would fall on the other. A mesh that nobody sees casts it from just below: cloth in
the air shades the table and the cloth under it, and never itself. Another one has the pattern's coordinates for its
vertices: `static/weave.js` draws threads along them.
"""

import numpy as np
import viser

from app.ui.colours import Palette
from app.ui.lighting import ink, paint
from app.ui.thick_cloth import ThickCloth
from planner.motion.cloth_surface import ClothSurface

ROOT = "/cloth"

_EDGE_PX = 1.5
_SHADE_M = (0.0, 0.0, -0.03)
"""Where the mesh that casts the shadow is, beside the cloth (m): lying cloth has it inside the table."""
_NO_POINTS = np.zeros((3, 3))
_NO_TRIANGLES = np.zeros((1, 3), dtype=np.int64)


class ClothView:
    """Shows one cloth surface at a time."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Build the nodes of the cloth, without cloth yet."""
        add_mesh = scene.add_mesh_simple
        self._front = add_mesh(f"{ROOT}/front", _NO_POINTS, _NO_TRIANGLES, side="front", cast_shadow=False)
        self._back = add_mesh(f"{ROOT}/back", _NO_POINTS, _NO_TRIANGLES, side="back", cast_shadow=False)
        self._hem = add_mesh(f"{ROOT}/hem", _NO_POINTS, _NO_TRIANGLES, side="double", cast_shadow=False)
        self._shade = add_mesh(
            f"{ROOT}/shade", _NO_POINTS, _NO_TRIANGLES, side="double", opacity=0.0, position=_SHADE_M
        )
        self._pattern = add_mesh(f"{ROOT}/pattern", _NO_POINTS, _NO_TRIANGLES, visible=False)
        self._edges = scene.add_line_segments(
            f"{ROOT}/edges", np.zeros((1, 2, 3)), (0, 0, 0), thickness=_EDGE_PX, thickness_units="screen"
        )
        self._shown: ClothSurface | None = None

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        self._front.color, self._back.color = paint(palette.cloth_front), paint(palette.cloth_back)
        self._hem.color = paint(palette.cloth_hem)
        self._edges.colors = ink(palette.cloth_edge)

    def set_visible(self, *, is_visible: bool) -> None:
        """Show or hide the cloth."""
        for node in (self._front, self._back, self._hem, self._shade, self._edges):
            node.visible = is_visible

    def show(self, cloth: ClothSurface, layer_m: float) -> None:
        """Replace the surface shown, whose layers take a height in a stack (m)."""
        if cloth is self._shown:
            return
        self._shown = cloth
        thick = ThickCloth(cloth, layer_m)
        front, back = (face.astype(np.float32) for face in thick.faces)
        pattern = np.zeros_like(front)
        pattern[:, :2] = thick.pattern
        faces = thick.triangles.astype(np.uint32)
        is_recut = not np.array_equal(faces, self._front.faces)
        meshes = ((self._front, front), (self._back, back), (self._shade, front), (self._pattern, pattern))
        for mesh, vertices in meshes:
            mesh.vertices = vertices
            if is_recut:
                mesh.faces = faces
        hem, triangles = thick.hem
        self._hem.vertices = hem.astype(np.float32)
        if not np.array_equal(triangles, self._hem.faces):
            self._hem.faces = triangles.astype(np.uint32)
        self._edges.points = thick.edges.astype(np.float32)
