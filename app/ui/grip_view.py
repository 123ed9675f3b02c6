"""The primitive under way: where each hand grips and carries the cloth, and where the base drives."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from app.ui.colours import Palette
from app.ui.lighting import ink, paint
from planner.geometry.pose import Point3

ROOT = "/primitive"

_POINT_RADIUS_M = 0.005
_PATH_PX = 2.5
_ROUTE_PX = 3.0
_ABOVE_FLOOR_M = 0.006
_NAME_AT: Point3 = (-0.16, 0.0, 0.075)
"""Position of a hand's letter, in the tool frame (m): beside the palm."""


class GripView:
    """Grip points, paths from pick over the apex to place, hands named L and R, and routes on the floor."""

    def __init__(self, server: viser.ViserServer, hands: Mapping[str, str], floor_z_m: float) -> None:
        """Build the nodes, which stay hidden before `show`.

        Args:
            server: where to build the nodes ``/primitive/<arm>`` and ``/primitive/route``.
            hands: the node of each arm's hand, by the arm's name; its letter moves along with it.
            floor_z_m: the floor's height in the table frame (m), negative.
        """
        self._route_z_m = floor_z_m + _ABOVE_FLOOR_M
        self._hands = {arm: _HandMarks(server, arm, node) for arm, node in hands.items()}
        self._route = _polyline(server, f"{ROOT}/route", _ROUTE_PX)

    def remove(self) -> None:
        """Remove all marks."""
        self._route.remove()
        for marks in self._hands.values():
            marks.remove()

    def stand_on(self, floor_z_m: float) -> None:
        """Set the floor's height (m), for routes drawn from now on."""
        self._route_z_m = floor_z_m + _ABOVE_FLOOR_M

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        self._route.colors = ink(palette.route)
        for marks in self._hands.values():
            marks.recolour(palette)

    def show(self, primitive: Mapping[str, Any] | None) -> None:
        """Draw a primitive, given as in the plan's JSON, in place of the previous one; None draws nothing."""
        grips = {grip["arm"]: grip for grip in primitive["grips"]} if primitive else {}
        for arm, marks in self._hands.items():
            marks.show(grips.get(arm))
        waypoints = primitive.get("waypoints", ()) if primitive else ()
        self._route.visible = len(waypoints) > 1
        if len(waypoints) > 1:
            self._route.points = _legs([(x, y, self._route_z_m) for x, y, _ in waypoints])


class _HandMarks:
    """Pick, path and place of one hand, and its letter."""

    def __init__(self, server: viser.ViserServer, arm: str, hand: str) -> None:
        node = f"{ROOT}/{arm}"
        self._pick = _point(server, f"{node}/pick")
        self._place = _point(server, f"{node}/place")
        self._path = _polyline(server, f"{node}/path", _PATH_PX)
        self._name = server.scene.add_label(
            f"{hand}/name", arm[:1].upper(), position=_NAME_AT, depth_test=True, anchor="center-center", visible=False
        )

    def remove(self) -> None:
        for node in (self._pick, self._place, self._path, self._name):
            node.remove()

    def recolour(self, palette: Palette) -> None:
        self._pick.color = self._place.color = paint(palette.grip)
        self._path.colors = ink(palette.route)

    def show(self, grip: Mapping[str, Any] | None) -> None:
        for node in (self._pick, self._place, self._path, self._name):
            node.visible = grip is not None
        if grip is None:
            return
        points: list[Point3] = [grip[end] for end in ("pick", "apex", "place") if grip[end] is not None]
        self._pick.position, self._place.position = points[0], points[-1]
        self._path.points = _legs(points)


def _point(server: viser.ViserServer, node: str) -> viser.IcosphereHandle:
    return server.scene.add_icosphere(node, radius=_POINT_RADIUS_M, subdivisions=2, cast_shadow=False, visible=False)


def _polyline(server: viser.ViserServer, node: str, width_px: float) -> viser.LineSegmentsHandle:
    return server.scene.add_line_segments(
        node, np.zeros((1, 2, 3)), (0, 0, 0), thickness=width_px, thickness_units="screen", visible=False
    )


def _legs(points: Sequence[Point3]) -> NDArray[np.float32]:
    """Return the legs of a polyline, shape (n, 2, 3)."""
    corners = np.array(points, dtype=np.float32)
    return np.stack([corners[:-1], corners[1:]], axis=1)
