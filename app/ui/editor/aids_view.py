"""Shows one visitor's aids: handles, lines, the pile, the ghost of a fold. Other visitors do not see them."""

import numpy as np
import trimesh
import viser

from app.ui.cloth_view import ClothView
from app.ui.colours import Palette
from app.ui.dashes import dash_dot, solid
from app.ui.editor.aids import NO_AIDS, Aids, Ghost
from app.ui.editor.aim import CLOTH_HEIGHT_M
from app.ui.editor.pile_surface import height, pile_surface
from app.ui.lighting import ink, instance_paint, paint
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region

ROOT = "/editor"

_HANDLE_PX, _MIDDLE_PX, _CHOSEN_PX = 5.5, 3.5, 8.0
_LINE_PX, _GHOST_PX = 2.0, 5.0
_LANDED_OPACITY = 0.35
_PILE_M = CLOTH_HEIGHT_M + 0.006
_ABOVE_M = 0.002
_NO_CORNERS, _NO_TRIANGLES, _NO_SEGMENTS = np.zeros((3, 3)), np.zeros((1, 3), dtype=np.int64), np.zeros((1, 2, 3))
_BALL = trimesh.creation.icosphere(subdivisions=2, radius=1.0)


class AidsView:
    """Nodes below ``/editor``; only the changed ones are rebuilt."""

    def __init__(self, client: viser.ClientHandle, palette: Palette) -> None:
        """Build the nodes, without aids at first."""
        self._scene = client.scene
        self._palette = palette
        self._shown = NO_AIDS
        self._pixel_m = 0.0
        self._handles: viser.BatchedMeshHandle | None = None
        self._lines = self._add_lines("lines", _LINE_PX)
        self._ghost = self._add_lines("ghost", _GHOST_PX)
        self._landed = client.scene.add_mesh_simple(
            f"{ROOT}/landed",
            _NO_CORNERS,
            _NO_TRIANGLES,
            side="double",
            opacity=_LANDED_OPACITY,
            cast_shadow=False,
            receive_shadow=False,
            visible=False,
        )
        self._pile = ClothView(client.scene, f"{ROOT}/pile")
        self._pile.set_visible(is_visible=False)
        self.recolour(palette)

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        self._palette = palette
        self._lines.colors = ink(palette.grip)
        self._pile.recolour(palette)
        self._draw_ghost(self._shown.ghost, self._top_m)
        if self._handles is not None:
            self._handles.batched_colors = np.array(instance_paint(palette.grip), dtype=np.uint8)

    def show(self, aids: Aids, pixel_m: float) -> None:
        """Replace the aids shown.

        Args:
            aids: the aids.
            pixel_m: the length on the table that one pixel covers (m); it keeps handles the same size on the screen.
        """
        before, self._shown = self._shown, aids
        is_zoomed, self._pixel_m = pixel_m != self._pixel_m, pixel_m
        if aids.pile != before.pile:
            self._pile.set_visible(is_visible=aids.pile is not None)
            if aids.pile is not None:
                self._pile.show(pile_surface(aids.pile, _PILE_M))
        if _grabbed(aids) != _grabbed(before) or is_zoomed:
            self._draw_handles(aids)
        if (aids.lines, aids.pile) != (before.lines, before.pile):
            self._draw_lines(aids)
        if (aids.ghost, aids.pile) != (before.ghost, before.pile):
            self._draw_ghost(aids.ghost, self._top_m)

    @property
    def _top_m(self) -> float:
        """The height above everything that lies there (m)."""
        pile = self._shown.pile
        return (CLOTH_HEIGHT_M if pile is None else _PILE_M + height(pile)) + _ABOVE_M

    def _draw_handles(self, aids: Aids) -> None:
        points = aids.handles + aids.middles
        count = len(points)
        sizes = np.full(count, _HANDLE_PX * self._pixel_m, dtype=np.float32)
        sizes[len(aids.handles) :] = _MIDDLE_PX * self._pixel_m
        if aids.chosen is not None:
            sizes[aids.chosen] = _CHOSEN_PX * self._pixel_m
        places = _raised(points, self._top_m).astype(np.float32)
        if self._handles is not None and len(self._handles.batched_positions) == count:
            self._handles.batched_positions, self._handles.batched_scales = places, sizes
            return
        if self._handles is not None:
            self._handles.remove()
            self._handles = None
        if count:
            self._handles = self._scene.add_batched_meshes_simple(
                f"{ROOT}/handles",
                np.asarray(_BALL.vertices),
                np.asarray(_BALL.faces),
                np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
                places,
                batched_scales=sizes,
                batched_colors=instance_paint(self._palette.grip),
                lod="off",
                cast_shadow=False,
                receive_shadow=False,
            )

    def _draw_lines(self, aids: Aids) -> None:
        legs = [_legs(_raised(line, self._top_m)) for line in aids.lines if len(line) > 1]
        self._lines.visible = bool(legs)
        if legs:
            self._lines.points = np.concatenate(legs).astype(np.float32)

    def _draw_ghost(self, ghost: Ghost | None, top_m: float) -> None:
        self._ghost.visible = ghost is not None
        self._landed.visible = ghost is not None and bool(ghost.landed)
        if ghost is None:
            return
        colour = self._palette.fold_red if ghost.is_red else self._palette.fold_blue
        cut = dash_dot if ghost.is_red else solid
        legs = cut(np.array(ghost.line.start), np.array(ghost.line.end))
        heights = np.full((*legs.shape[:2], 1), top_m + 2 * _ABOVE_M)
        self._ghost.colors = ink(colour)
        self._ghost.points = np.concatenate([legs, heights], axis=2).astype(np.float32)
        if ghost.landed:
            flat = np.concatenate([Region.polygon(ring).triangles for ring in ghost.landed]).reshape(-1, 2)
            self._landed.color = paint(colour)
            self._landed.vertices = np.column_stack([flat, np.full(len(flat), top_m + _ABOVE_M)]).astype(np.float32)
            self._landed.faces = np.arange(len(flat), dtype=np.uint32).reshape(-1, 3)

    def _add_lines(self, name: str, width_px: float) -> viser.LineSegmentsHandle:
        return self._scene.add_line_segments(
            f"{ROOT}/{name}", _NO_SEGMENTS, (0, 0, 0), thickness=width_px, thickness_units="screen", visible=False
        )


def _grabbed(aids: Aids) -> tuple[object, ...]:
    """Return everything that decides how handles are drawn."""
    return aids.handles, aids.middles, aids.chosen, aids.pile


def _raised(points: tuple[Point2, ...], height_m: float) -> FloatArray:
    flat = np.array(points, dtype=float).reshape(-1, 2)
    return np.column_stack([flat, np.full(len(flat), height_m)])


def _legs(corners: FloatArray) -> FloatArray:
    """Return the legs of a polyline, shape (n, 2, 3)."""
    return np.stack([corners[:-1], corners[1:]], axis=1)
