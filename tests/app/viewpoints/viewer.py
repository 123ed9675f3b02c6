"""A viewer of the 3D view without a browser: it sends the messages of viser's page, and reads what the page reads."""

import time
from collections.abc import Callable
from typing import Any

import msgspec.msgpack
import zstandard
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from app.ui.view_3d import View3D
from app.ui.viewpoints.presets import Preset
from app.ui.viewpoints.viewpoint_choice import CHANNEL
from app.ui.viser_patches import LOOPBACK, SECRET_HEADER
from planner.geometry.pose import Point3
from tests.patience import PATIENCE_S

SUBPROTOCOL = Subprotocol("viser-v1.1.1")
EYE = (0.0, 0.0, 2.0)
ROBOT = "/robot"


class Viewer:
    """A viewer that looks at the middle of the table from 2 m above it, unless its camera is set.

    Attributes:
        nodes: the names of the scene's nodes.
        robot: where the scene has the robot (m).
        camera: the places that the server has sent the camera to.
    """

    def __init__(self, view: View3D, eye: Point3 = EYE, size: tuple[int, int] = (800, 500)) -> None:
        self._socket = connect(
            f"ws://{LOOPBACK}:{view.port}",
            subprotocols=[SUBPROTOCOL],
            additional_headers={SECRET_HEADER: view.secret},
            proxy=None,
            max_size=None,
        )
        self.nodes: set[str] = set()
        self.robot: Point3 = (0.0, 0.0, 0.0)
        self.camera: list[Point3] = []
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

    def __enter__(self) -> "Viewer":
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def until(self, condition: Callable[[], Any]) -> None:
        """Read on until a condition holds."""
        deadline = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < deadline
            self._read()

    def glide_until(self, condition: Callable[[], Any]) -> None:
        """Read on until a condition holds, and report the camera wherever it is sent, as a browser does."""
        reported = 0

        def is_met() -> bool:
            nonlocal reported
            if len(self.camera) > reported:
                reported = len(self.camera)
                self.look(self.camera[-1], (800, 500))
            return bool(condition())

        self.until(is_met)

    def choose(self, preset: Preset) -> None:
        """Choose a viewpoint, as the page does."""
        self.until(lambda: self.channel is not None)
        self._say("GuiUpdateMessage", uuid=str(self.channel).removeprefix(CHANNEL), updates={"value": str(preset)})

    @property
    def channel(self) -> str | None:
        """The node that names its session's choice of a viewpoint; None before it is there."""
        return next((name for name in self.nodes if name.startswith(CHANNEL)), None)

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
        if kind == "RemoveSceneNodeMessage":
            self.nodes.discard(str(name))
        elif kind == "SetCameraPositionMessage":
            x, y, z = message["position"]
            self.camera.append((x, y, z))
        elif kind == "SetPositionMessage" and name == ROBOT:
            x, y, z = message["position"]
            self.robot = (x, y, z)
        elif name and "props" in message:
            self.nodes.add(name)
