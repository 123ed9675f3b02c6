"""What stands still: the floor, the table, the stations."""

import numpy as np
import viser

from app.ui.colours import Palette
from app.ui.rotation import yaw
from planner.geometry.pose import Pose2
from planner.primitives.scene import Scene

_TOP_THICKNESS_M = 0.03
_ABOVE_FLOOR_M = 0.004
_ARROW = np.array([[0.16, 0.0, 0.0], [-0.10, 0.11, 0.0], [-0.04, 0.0, 0.0], [-0.10, -0.11, 0.0]])


class TableView:
    """Floor, table and stations; built once for a scene."""

    def __init__(self, server: viser.ViserServer, scene: Scene, palette: Palette) -> None:
        """Build the nodes ``/floor``, ``/table`` and ``/stations``."""
        self._server = server
        self._palette = palette
        self._floor_z_m = -scene.table.height_m
        self._add_floor()
        self._add_table(scene)
        for name, pose in scene.stations:
            self._add_station(name, pose)

    def _add_floor(self) -> None:
        self._server.scene.add_grid(
            "/floor",
            plane="xy",
            position=(0.0, 0.0, self._floor_z_m),
            infinite_grid=True,
            fade_distance=9.0,
            cell_size=0.25,
            section_size=1.0,
            cell_thickness=0.4,
            section_thickness=0.7,
            cell_color=self._palette.floor_cell,
            section_color=self._palette.floor_section,
            shadow_opacity=0.25,
        )

    def _add_table(self, scene: Scene) -> None:
        """A top, and one foot in its middle: a robot's base goes under the edges."""
        table = scene.table
        foot_m = table.height_m - _TOP_THICKNESS_M
        add_box = self._server.scene.add_box
        add_box(
            "/table/top",
            dimensions=(table.depth_m, table.width_m, _TOP_THICKNESS_M),
            position=(0.0, 0.0, -_TOP_THICKNESS_M / 2),
            color=self._palette.table,
        )
        add_box(
            "/table/foot",
            dimensions=(table.depth_m * 0.35, table.width_m * 0.12, foot_m),
            position=(0.0, 0.0, -_TOP_THICKNESS_M - foot_m / 2),
            color=self._palette.table_foot,
        )

    def _add_station(self, name: str, pose: Pose2) -> None:
        """A flat arrow on the floor where the base stands and looks, with the station's name behind it."""
        node = f"/stations/{name}"
        self._server.scene.add_mesh_simple(
            node,
            _ARROW,
            np.array([[0, 1, 2], [0, 2, 3]]),
            color=self._palette.station,
            side="double",
            cast_shadow=False,
            position=(pose.x_m, pose.y_m, self._floor_z_m + _ABOVE_FLOOR_M),
            wxyz=yaw(pose.yaw_rad),
        )
        self._server.scene.add_label(
            f"{node}/name",
            name,
            position=(-0.2, 0.0, 0.0),
            font_screen_scale=0.8,
            depth_test=True,
            anchor="center-center",
        )
