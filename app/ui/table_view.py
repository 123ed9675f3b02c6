"""The static scene: the floor, the table, the stations."""

import numpy as np
import viser

from app.language import ENGLISH, Language, named
from app.ui.colours import Palette
from app.ui.lighting import paint
from app.ui.rotation import yaw
from planner.geometry.pose import Pose2
from planner.geometry.table_parts import table_parts
from planner.task.scene import Scene

_ABOVE_FLOOR_M = 0.004
_ARROW = np.array([[0.16, 0.0, 0.0], [-0.10, 0.11, 0.0], [-0.04, 0.0, 0.0], [-0.10, -0.11, 0.0]])


class TableView:
    """Floor, table and stations; built once for a scene."""

    def __init__(
        self, server: viser.ViserServer, scene: Scene, *, has_stations: bool, language: Language = ENGLISH
    ) -> None:
        """Build the nodes ``/floor``, ``/table`` and ``/stations``.

        Args:
            server: where to build them.
            scene: table and stations.
            has_stations: whether to mark the stations: a base that does not drive has none to go to.
            language: the language of the stations' names.
        """
        self._server = server
        self._floor_z_m = -scene.table.height_m
        self._floor = self._add_floor()
        self._top, *self._legs = self._add_table(scene)
        marked = scene.stations if has_stations else ()
        self._stations = [self._add_station(name, pose) for name, pose in marked]
        self._names = [(name, self._add_name(name, language)) for name, _ in marked]

    def remove(self) -> None:
        """Remove all nodes."""
        for part in (self._floor, self._top, *self._legs, *self._stations):
            part.remove()

    def recolour(self, palette: Palette) -> None:
        """Change to other colours."""
        floor = self._floor
        floor.plane_color, floor.cell_color, floor.section_color = (
            palette.floor,
            palette.floor_cell,
            palette.floor_section,
        )
        self._top.color = paint(palette.table)
        for leg in self._legs:
            leg.color = paint(palette.table_foot)
        for station in self._stations:
            station.color = paint(palette.station)

    def mark_stations(self, *, is_marked: bool) -> None:
        """Show or hide the stations' arrows and names."""
        for station in self._stations:
            station.visible = is_marked

    def speak(self, language: Language) -> None:
        """Name the stations in another language."""
        for name, label in self._names:
            label.text = named(language, "station", name)

    def _add_floor(self) -> viser.GridHandle:
        return self._server.scene.add_grid(
            "/floor",
            plane="xy",
            position=(0.0, 0.0, self._floor_z_m),
            infinite_grid=True,
            fade_distance=12.0,
            cell_size=0.25,
            section_size=1.0,
            cell_thickness=0.4,
            section_thickness=0.7,
            shadow_opacity=0.4,
            plane_opacity=1.0,
        )

    def _add_table(self, scene: Scene) -> list[viser.BoxHandle]:
        """Add the top and the legs, as the boxes that the robot keeps clear of."""
        return [
            self._server.scene.add_box(
                f"/table/{part.name.removeprefix('table ').replace(' ', '_')}",
                dimensions=part.size,
                position=part.center,
            )
            for part in table_parts(scene.table)
        ]

    def _add_station(self, name: str, pose: Pose2) -> viser.MeshHandle:
        """Add a flat arrow on the floor at the base's pose."""
        return self._server.scene.add_mesh_simple(
            f"/stations/{name}",
            _ARROW,
            np.array([[0, 1, 2], [0, 2, 3]]),
            side="double",
            cast_shadow=False,
            position=(pose.x_m, pose.y_m, self._floor_z_m + _ABOVE_FLOOR_M),
            wxyz=yaw(pose.yaw_rad),
        )

    def _add_name(self, station: str, language: Language) -> viser.LabelHandle:
        """Add a station's name behind its arrow, with which it goes."""
        return self._server.scene.add_label(
            f"/stations/{station}/name",
            named(language, "station", station),
            position=(-0.2, 0.0, 0.0),
            font_screen_scale=0.8,
            depth_test=True,
            anchor="center-center",
        )
