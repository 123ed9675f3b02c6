"""A visitor of a 3D view without a browser: it sends the messages of viser's page, and reads what the page reads."""

import time
from collections.abc import Callable
from typing import Any

import msgspec.msgpack
import zstandard
from websockets.sync.client import connect

from app.ui.editor.aim import CLOTH_HEIGHT_M
from app.ui.editor.pointer_capture import NODE
from app.ui.view_3d import View3D
from app.ui.viser_patches import LOOPBACK, SECRET_HEADER
from planner.geometry.pose import Point2, Point3
from tests.patience import PATIENCE_S

SUBPROTOCOL = "viser-v1.1.1"
EYE = (0.0, 0.0, 2.0)


class Visitor:
    """A visitor who looks at the middle of the table from 2 m above it, unless its camera is set.

    Attributes:
        nodes: the scene as it is shown, by name: properties, and whether it is visible.
        controls: the panel's controls, by label.
        camera: the places that the server has sent the camera to.
    """

    def __init__(self, view: View3D, eye: Point3 = EYE, size: tuple[int, int] = (800, 500)) -> None:
        self._socket = connect(
            f"ws://{LOOPBACK}:{view.port}",
            subprotocols=[SUBPROTOCOL],  # type: ignore[list-item]
            additional_headers={SECRET_HEADER: view.secret},
            proxy=None,
            max_size=None,
        )
        self.nodes: dict[str, dict[str, Any]] = {}
        self.controls: dict[str, dict[str, Any]] = {}
        self.camera: list[tuple[float, ...]] = []
        self.look(eye, size)

    def look(self, eye: Point3, size: tuple[int, int]) -> None:
        """Report the camera's pose, and the picture's width and height (px)."""
        self._say(
            "ViewerCameraMessage",
            wxyz=(0.0, 1.0, 0.0, 0.0),
            position=eye,
            fov=0.72,
            near=0.01,
            far=1000.0,
            image_height=size[1],
            image_width=size[0],
            look_at=(0.0, 0.0, 0.0),
            up_direction=(0.0, 0.0, 1.0),
        )

    def __enter__(self) -> "Visitor":
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def until(self, condition: Callable[[], Any]) -> None:
        """Read on until a condition holds."""
        deadline = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < deadline
            self._read()

    def choose(self, label: str, value: str) -> None:
        """Choose an entry in a list of the panel, or press the button of that name in a group."""
        self.until(lambda: label in self.controls)
        self._say("GuiUpdateMessage", uuid=self.controls[label]["uuid"], updates={"value": value})

    def push(self, label: str) -> None:
        """Press a button of the panel."""
        self.until(lambda: label in self.controls)
        self._say("GuiUpdateMessage", uuid=self.controls[label]["uuid"], updates={"value": True})

    def is_shown(self, node: str) -> bool:
        return node in self.nodes and bool(self.nodes[node]["visible"])

    def touch(self, phase: str, start: Point2, end: Point2, modifier: str | None = None) -> None:
        """Drag on the capture box: report where the pointer went down on the cloth, where it is, and the keys held."""
        places = {"start_position": beyond(start), "end_position": beyond(end)}
        screen = {"start_screen_pos": (0.5, 0.5), "end_screen_pos": (0.5, 0.5)}
        self._say(
            "SceneNodeDragMessage",
            phase=phase,
            name=NODE,
            instance_index=None,
            **places,
            **screen,
            button="left",
            modifier=modifier,
            owner=self.nodes[NODE]["owner"],
        )

    def click(self, point: Point2) -> None:
        along = tuple(there - here for here, there in zip(EYE, beyond(point), strict=True))
        self._say(
            "SceneNodeClickMessage",
            name=NODE,
            instance_index=None,
            ray_origin=EYE,
            ray_direction=along,
            screen_pos=(0.5, 0.5),
            modifier=None,
            owner=self.nodes[NODE]["owner"],
        )

    def _say(self, kind: str, **fields: Any) -> None:
        self._socket.send(msgspec.msgpack.encode({"type": kind, **fields}))

    def _read(self) -> None:
        try:
            raw = self._socket.recv(timeout=0.2)
        except TimeoutError:
            return
        assert isinstance(raw, bytes)
        packed = raw[16 : 16 + int.from_bytes(raw[8:16], "little")]
        for message in msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(packed))["messages"]:
            self._take(message)

    def _take(self, message: dict[str, Any]) -> None:
        kind, name = message["type"], message.get("name")
        if kind == "GuiUpdateMessage":
            control = next((c for c in self.controls.values() if c["uuid"] == message["uuid"]), None)
            if control is not None:
                control["props"].update(message["updates"])
        elif kind.startswith("Gui") and "props" in message:
            self.controls[message["props"].get("label") or kind] = message
        elif kind == "RemoveSceneNodeMessage":
            self.nodes.pop(str(name), None)
        elif kind == "SetSceneNodeVisibilityMessage" and name in self.nodes:
            self.nodes[name]["visible"] = message["visible"]
        elif kind == "SceneNodeUpdateMessage" and name in self.nodes:
            self.nodes[name].update(message["updates"])
        elif kind == "SetCameraPositionMessage":
            self.camera.append(tuple(message["position"]))
        elif name and "props" in message:
            self.nodes[name] = {"visible": True, "owner": message.get("owner", ""), **message["props"]}


def beyond(point: Point2) -> tuple[float, float, float]:
    """Return where the ray through a point of the cloth meets the capture box: a thousand times as far from the eye."""
    x, y, z = EYE
    u, v = point
    return (x + 1000 * (u - x), y + 1000 * (v - y), z + 1000 * (CLOTH_HEIGHT_M - z))
