"""The panel with places to look from; it moves nobody's camera but that of the visitor who pressed.

The robot's eye goes along with the robot until the visitor takes the camera elsewhere. What a browser tells of its
camera is a little old: it is taken elsewhere when it is at none of the places where it has been put lately.
"""

from collections import deque
from collections.abc import Callable

import viser

from app.ui.editor.presets import Lens, Preset
from app.ui.viewpoint import Viewpoint

LABEL = "Camera"

_REMEMBERED = 8
"""How many openings: what a browser tells of its camera may be some of them old."""

_RIDDEN = 90
"""The same of a camera that goes along with the robot: three seconds of them."""

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
        self._openings = deque([opening], _REMEMBERED)
        self._has_begun = self._is_left = False
        self._preset: Viewpoint | None = None
        self._ridden: deque[Viewpoint] = deque(maxlen=_RIDDEN)
        self._folder = client.gui.add_folder(LABEL)
        with self._folder:
            self._buttons = client.gui.add_button_group("Look from", tuple(preset.value for preset in Preset))
        self._buttons.on_click(self._pressed)

    @property
    def lens(self) -> Lens:
        """What the camera takes in."""
        return Lens(self._camera.image_width / max(self._camera.image_height, 1))

    @property
    def is_opening(self) -> bool:
        """Whether the camera is where it was put at first: nobody has moved it since or pressed a button.

        A browser may tell of a camera before it has put it anywhere.
        """
        is_there = not all(self._has_moved(opening) for opening in self._openings)
        self._is_left = self._is_left or (self._has_begun and not is_there)
        self._has_begun = self._has_begun or is_there
        return is_there and not self._is_left

    def open_on(self, viewpoint: Viewpoint) -> None:
        """Begin at another place, if the camera is still where it was put at first."""
        if self.is_opening and self._has_moved(viewpoint):
            self._openings.append(viewpoint)
            self._free = viewpoint
            self._move(viewpoint)

    def go_to(self, viewpoint: Viewpoint) -> None:
        """Go to a place, and remember the one where somebody has gone by hand."""
        self._is_left = True
        if self._preset is None or (self._has_moved(self._preset) and not self.is_riding):
            self._free = self._here
        self._ridden.clear()
        self._preset = viewpoint
        self._move(viewpoint)

    def ride(self, viewpoint: Viewpoint) -> None:
        """Go to a place that moves, and along with it from now on."""
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
        """Whether the camera goes along with something: nobody has moved it since."""
        return any(not self._has_moved(place) for place in self._ridden)

    def go_back(self) -> None:
        """Go to where the camera was before the places that were chosen here."""
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
