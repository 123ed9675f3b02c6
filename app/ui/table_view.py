"""The static scene: the floor and the table."""

import viser

from app.ui.colours import Palette
from app.ui.lighting import paint
from planner.geometry.table import table_parts
from planner.task.scene import Scene


class TableView:
    """Floor and table; built once for a scene."""

    def __init__(self, server: viser.ViserServer, scene: Scene) -> None:
        """Build the nodes ``/floor`` and ``/table``."""
        self._server = server
        self._floor_z_m = -scene.table.height_m
        self._floor = self._add_floor()
        self._top, *self._legs = self._add_table(scene)

    def remove(self) -> None:
        """Remove all nodes."""
        for part in (self._floor, self._top, *self._legs):
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
