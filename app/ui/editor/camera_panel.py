"""The panel with places to look from; it moves nobody's camera but that of the visitor who pressed."""

from collections.abc import Callable

import viser

from app.ui.editor.presets import Lens, Preset
from app.ui.viewpoint import Viewpoint

LABEL = "Camera"

OnPreset = Callable[[Preset], None]


class CameraPanel:
    """A row of buttons, and the memory of where the camera was before the first of them."""

    def __init__(self, client: viser.ClientHandle, opening: Viewpoint, on_preset: OnPreset) -> None:
        """Build the folder.

        Args:
            client: whose camera it is.
            opening: where a camera is at first.
            on_preset: is told what has been pressed, and must not block.
        """
        self._camera = client.camera
        self._client = client
        self._on_preset = on_preset
        self._free = opening
        self._preset: Viewpoint | None = None
        self._folder = client.gui.add_folder(LABEL)
        with self._folder:
            self._buttons = client.gui.add_button_group("Look from", tuple(preset.value for preset in Preset))
        self._buttons.on_click(self._pressed)

    @property
    def lens(self) -> Lens:
        """What the camera takes in."""
        return Lens(self._camera.aspect)

    def go_to(self, viewpoint: Viewpoint) -> None:
        """Go to a place, and remember the one where somebody has gone by hand."""
        if self._preset is None or self._has_moved(self._preset):
            self._free = self._here
        self._preset = viewpoint
        self._move(viewpoint)

    def go_back(self) -> None:
        """Go to where the camera was before the places that were chosen here."""
        self._preset = None
        self._move(self._free)

    async def _pressed(self, event: viser.GuiEvent[viser.GuiButtonGroupHandle]) -> None:
        self._on_preset(Preset(event.target.value))

    @property
    def _here(self) -> Viewpoint:
        (x, y, z), (u, v, w) = self._camera.position.tolist(), self._camera.look_at.tolist()
        return Viewpoint((x, y, z), (u, v, w), float(self._camera.fov))

    def _has_moved(self, preset: Viewpoint) -> bool:
        return any(abs(now - then) > 1e-2 for now, then in zip(self._here.position, preset.position, strict=True))

    def _move(self, viewpoint: Viewpoint) -> None:
        with self._client.atomic():
            self._camera.up_direction = (0.0, 0.0, 1.0)
            self._camera.position = viewpoint.position
            self._camera.look_at = viewpoint.look_at
            self._camera.fov = viewpoint.fov_rad
