"""The choice of a viewpoint; it moves only the camera of the visitor who chose it.

Its buttons stand on the page, over the 3D view (`static/js/view3d.js`). A page knows its visitor only by the name
that viser gives the choice, which a node of the visitor's own scene tells it.

The robot's-eye camera follows the robot until the visitor moves it. A browser reports its camera with a delay: it
counts as moved when it is at none of the viewpoints it was recently sent to.
"""

from collections import deque
from collections.abc import Callable

import viser

from app.ui.viewpoint import Viewpoint
from app.ui.viewpoints.presets import Lens, Preset

CHANNEL = "/session/"
"""The beginning of the name of a session's scene node; the rest is viser's name for the choice of a viewpoint."""

_REMEMBERED = 90
"""Number of viewpoints remembered, because a browser reports its camera with a delay: three seconds of following."""

OnPreset = Callable[[Preset], None]


class ViewpointChoice:
    """A choice that no panel shows, and the viewpoint before it was first made."""

    def __init__(self, client: viser.ClientHandle, opening: Viewpoint, on_preset: OnPreset) -> None:
        """Build the choice.

        Args:
            client: whose camera it is.
            opening: the opening viewpoint.
            on_preset: called with the preset pressed; must not block.
        """
        self._camera = client.camera
        self._client = client
        self._on_preset = on_preset
        self._free = opening
        self._openings = deque([opening], _REMEMBERED)
        self._has_begun = self._is_left = False
        self._preset: Viewpoint | None = None
        self._ridden: deque[Viewpoint] = deque(maxlen=_REMEMBERED)
        buttons = client.gui.add_button_group("", tuple(Preset), visible=False)
        buttons.on_click(self._pressed)
        client.scene.add_frame(f"{CHANNEL}{buttons._impl.uuid}", show_axes=False)  # it has no other name

    @property
    def lens(self) -> Lens:
        """The camera's aspect and field of view."""
        return Lens(self._camera.image_width / max(self._camera.image_height, 1))

    @property
    def is_opening(self) -> bool:
        """Whether the camera is still at its opening: nobody has moved it or pressed a button.

        A browser may report a camera before it has been sent anywhere.
        """
        is_there = not all(self._has_moved(opening) for opening in self._openings)
        self._is_left = self._is_left or (self._has_begun and not is_there)
        self._has_begun = self._has_begun or is_there
        return is_there and not self._is_left

    def open_on(self, viewpoint: Viewpoint) -> None:
        """Change the opening viewpoint, if the camera is still at its opening."""
        if self.is_opening and self._has_moved(viewpoint):
            self._openings.append(viewpoint)
            self._free = viewpoint
            self._move(viewpoint)

    def go_to(self, viewpoint: Viewpoint) -> None:
        """Go to a viewpoint, and remember a viewpoint that the visitor had chosen by hand."""
        self._is_left = True
        if self._preset is None or (self._has_moved(self._preset) and not self.is_riding):
            self._free = self._here
        self._ridden.clear()
        self._preset = viewpoint
        self._move(viewpoint)

    def ride(self, viewpoint: Viewpoint) -> None:
        """Go to a moving viewpoint and follow it from now on."""
        if not self.is_riding:
            before = self._here
            self.go_to(viewpoint)
            self._ridden.extend((before, viewpoint))
        elif viewpoint != self._ridden[-1]:
            self._ridden.append(viewpoint)
            self._preset = viewpoint
            self._move(viewpoint)

    @property
    def is_riding(self) -> bool:
        """Whether the camera follows a moving viewpoint and nobody has moved it since."""
        return any(not self._has_moved(place) for place in self._ridden)

    def go_back(self) -> None:
        """Go back to the viewpoint before those chosen here."""
        self._ridden.clear()
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
