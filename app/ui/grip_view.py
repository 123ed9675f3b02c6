"""What the primitive under way does: where each hand grips and carries the cloth, where the base drives."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from app.ui.colours import Palette
from planner.geometry.pose import Point3

ROOT = "/primitive"

_GRIP_RADIUS_M = 0.012
_PATH_PX = 2.5
_ROUTE_PX = 3.0
_ABOVE_FLOOR_M = 0.006


class GripView:
    """Grip points named L and R, paths from pick by the apex to the place, and routes on the floor."""

    def __init__(self, server: viser.ViserServer, arms: Sequence[str], floor_z_m: float, palette: Palette) -> None:
        """Nothing is seen before `show`.

        Args:
            server: where to build the nodes ``/primitive/<arm>`` and ``/primitive/route``.
            arms: the arms' names.
            floor_z_m: the floor's height in the table frame (m), negative.
            palette: the colours.
        """
        self._route_z_m = floor_z_m + _ABOVE_FLOOR_M
        self._hands = {arm: _HandMarks(server, arm, palette) for arm in arms}
        self._route = _polyline(server, f"{ROOT}/route", _ROUTE_PX, palette)

    def show(self, primitive: Mapping[str, Any] | None) -> None:
        """Draw a primitive, given as in the plan's JSON, in place of the one before; None draws nothing."""
        grips = {grip["arm"]: grip for grip in primitive["grips"]} if primitive else {}
        for arm, marks in self._hands.items():
            marks.show(grips.get(arm))
        waypoints = primitive.get("waypoints", ()) if primitive else ()
        self._route.visible = len(waypoints) > 1
        if len(waypoints) > 1:
            self._route.points = _legs([(x, y, self._route_z_m) for x, y, _ in waypoints])


class _HandMarks:
    """Pick, path and place of one hand."""

    def __init__(self, server: viser.ViserServer, arm: str, palette: Palette) -> None:
        node = f"{ROOT}/{arm}"
        self._pick = _point(server, f"{node}/pick", palette)
        self._place = _point(server, f"{node}/place", palette)
        self._path = _polyline(server, f"{node}/path", _PATH_PX, palette)
        self._name = server.scene.add_label(f"{node}/name", arm[:1].upper(), anchor="bottom-left", visible=False)

    def show(self, grip: Mapping[str, Any] | None) -> None:
        for node in (self._pick, self._place, self._path, self._name):
            node.visible = grip is not None
        if grip is None:
            return
        points: list[Point3] = [grip[end] for end in ("pick", "apex", "place") if grip[end] is not None]
        self._pick.position = self._name.position = points[0]
        self._place.position = points[-1]
        self._path.points = _legs(points)


def _point(server: viser.ViserServer, node: str, palette: Palette) -> viser.IcosphereHandle:
    return server.scene.add_icosphere(
        node, radius=_GRIP_RADIUS_M, color=palette.grip, subdivisions=2, cast_shadow=False, visible=False
    )


def _polyline(server: viser.ViserServer, node: str, width_px: float, palette: Palette) -> viser.LineSegmentsHandle:
    return server.scene.add_line_segments(
        node,
        np.zeros((1, 2, 3)),
        palette.route,
        thickness=width_px,
        thickness_units="screen",
        visible=False,
    )


def _legs(points: Sequence[Point3]) -> NDArray[np.float32]:
    """The legs of a polyline, shape (n, 2, 3)."""
    corners = np.array(points, dtype=np.float32)
    return np.stack([corners[:-1], corners[1:]], axis=1)
