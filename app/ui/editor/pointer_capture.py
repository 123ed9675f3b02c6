"""Pointer capture: an invisible box round the scene that catches the pointer while a visitor draws.

viser's camera stays where it is while a node is dragged. With the box every point of the picture belongs to a node, so
no gesture with the left button can turn the camera. The box lies beyond what the camera sees, and so does the arrow
that viser draws while a node is dragged. Only its inside faces the camera, so it is not outlined either when the
pointer is over it.

viser splits a drag where a modifier key goes down or up: it reports an end, and if the button is still held a tenth of
a second later, or the pointer moves on, a start at the same point of the node. Here such a drag counts as a single
drag: an end counts only once no such start has followed.
"""

import asyncio
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
import viser

from app.ui.editor.aim import Aim, aim, pixel_angle
from planner.geometry.pose import Point3
from planner.geometry.tolerance import GRID_M

NODE = "/editor/pointer_capture"

_HALF_M = 2048.0  # beyond the camera's far plane at 1000 m
_CORNERS = _HALF_M * np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], dtype=float)
_INWARDS = np.array(
    [
        *([0, 1, 3], [0, 3, 2]),  # below, seen from above
        *([4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4]),
        *([1, 5, 7], [1, 7, 3]),
    ]
)

_Modifier: TypeAlias = Literal[
    "cmd/ctrl", "alt", "shift", "cmd/ctrl+alt", "cmd/ctrl+shift", "alt+shift", "cmd/ctrl+alt+shift"
]
_MODIFIERS: tuple[_Modifier | None, ...] = (None, *get_args(_Modifier))
"""Modifier keys whose drags viser reports; keys that are held make no difference here."""

GOES_ON_S = 0.25
"""Time after its end in which a drag may go on with other keys (s): more than viser's tenth and the network's delay."""

Touch: TypeAlias = Literal["press", "drag", "release", "tap"]
OnTouch: TypeAlias = Callable[[Touch, Aim | None], None]


_DragEvent: TypeAlias = viser.SceneNodeDragEvent[viser.MeshHandle]


@dataclass(frozen=True, slots=True)
class _Ended:
    """A drag that viser has called ended.

    Attributes:
        start: where it began, on the box.
        modifier: the keys that were held.
        aim: where the pointer was.
        timer: the timer that will end the drag.
    """

    start: Point3
    modifier: _Modifier | None
    aim: Aim | None
    timer: asyncio.TimerHandle

    def goes_on_as(self, event: _DragEvent) -> bool:
        """Return whether a start continues this drag with other keys: it is at the same point of the box."""
        is_same_place = math.dist(self.start, event.start_position) <= GRID_M * _HALF_M
        return is_same_place and event.modifier != self.modifier


class PointerCapture:
    """The box of one visitor; it exists only while the visitor draws."""

    def __init__(self, client: viser.ClientHandle, on_touch: OnTouch) -> None:
        """Build nothing yet; `catch` adds the box.

        Args:
            client: the visitor.
            on_touch: called with what the pointer does, in viser's own thread; must not block.
        """
        self._client = client
        self._on_touch = on_touch
        self._ended: _Ended | None = None
        self._box = client.scene.add_mesh_simple(
            NODE, _CORNERS, _INWARDS, side="front", cast_shadow=False, receive_shadow=False, visible=False
        )
        for modifier in _MODIFIERS:
            self._box.on_drag("left", modifier=modifier)(self._dragged)
            self._box.on_click(modifier=modifier)(self._clicked)

    def catch(self, *, is_on: bool) -> None:
        """Catch the pointer from now on, or let it turn the camera."""
        if self._box.visible != is_on:
            self._box.visible = is_on

    async def _dragged(self, event: _DragEvent) -> None:
        aim = self._aim(event.end_position)
        if event.phase == "end":
            self._let_go()
            timer = asyncio.get_running_loop().call_later(GOES_ON_S, self._let_go)
            self._ended = _Ended(event.start_position, event.modifier, aim, timer)
            return
        if event.phase == "start":
            if self._ended is not None and self._ended.goes_on_as(event):
                self._ended.timer.cancel()
                self._ended = None
            else:
                self._let_go()
                self._on_touch("press", self._aim(event.start_position))
        self._on_touch("drag", aim)

    def _let_go(self) -> None:
        """End a drag that has not been continued."""
        ended, self._ended = self._ended, None
        if ended is not None:
            ended.timer.cancel()
            self._on_touch("release", ended.aim)

    async def _clicked(self, event: viser.SceneNodePointerEvent[viser.MeshHandle]) -> None:
        self._let_go()
        origin, along = event.ray_origin, event.ray_direction
        through = (origin[0] + along[0], origin[1] + along[1], origin[2] + along[2])
        self._on_touch("tap", aim(origin, through, self._pixel_rad))

    def _aim(self, through: Point3) -> Aim | None:
        x, y, z = (float(place) for place in self._client.camera.position)
        return aim((x, y, z), through, self._pixel_rad)

    @property
    def _pixel_rad(self) -> float:
        camera = self._client.camera
        return pixel_angle(camera.fov, camera.image_height)
