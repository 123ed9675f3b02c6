"""A page's websocket to a server without a network."""

import asyncio
import contextlib
import json
from collections.abc import Callable
from typing import Any

from starlette.types import ASGIApp, Message

from tests.app.conftest import OWN_URL
from tests.patience import PATIENCE_S


class Listener:
    """A listener that keeps the last message of each kind; all of them once `keep_all` is set."""

    def __init__(
        self, app: ASGIApp, path: str, client: str | None = None, extensions: dict[str, Any] | None = None
    ) -> None:
        self.last: dict[str, dict[str, Any]] = {}
        self.heard: list[dict[str, Any]] = []
        self.keep_all = False
        self.closed_with: int | None = None
        self.answered: Message | None = None
        self._inbox: asyncio.Queue[Message] = asyncio.Queue()
        self._told = asyncio.Event()
        self._inbox.put_nowait({"type": "websocket.connect"})
        scope: dict[str, Any] = {
            "type": "websocket",
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "scheme": "ws",
            "path": path,
            "raw_path": path.encode(),
            "query_string": b"",
            "root_path": "",
            "headers": [(b"host", OWN_URL.removeprefix("http://").encode())],
            "subprotocols": [],
            "state": {},
            "extensions": extensions or {},
        }
        if client is not None:
            scope["client"] = (client, 1)
        self._task = asyncio.ensure_future(app(scope, self._inbox.get, self._send))

    def say(self, command: object) -> None:
        self._inbox.put_nowait({"type": "websocket.receive", "text": json.dumps(command)})

    async def until(self, kind: str, **wanted: object) -> dict[str, Any]:
        """Wait for a message of a kind that has these fields."""
        await self._once(lambda: kind in self.last and wanted.items() <= self.last[kind].items())
        return self.last[kind]

    async def until_planned(self, version: int) -> dict[str, Any]:
        """Wait for the final plan of a version, and for its playback; return the plan's message."""
        await self.until("plan", status="solved", version=version)
        await self._once(lambda: self.last["plan"]["plan"]["is_final"])
        plan = self.last["plan"]
        await self.until("playback", version=version, duration_s=plan["plan"]["cost_s"])
        return plan

    async def hang_up(self) -> None:
        self._inbox.put_nowait({"type": "websocket.disconnect", "code": 1001})
        with contextlib.suppress(asyncio.CancelledError):
            await asyncio.wait_for(self._task, 10.0)

    async def has_ended(self) -> None:
        """Wait until the server has closed the connection, or has refused it."""
        await asyncio.wait_for(self._task, PATIENCE_S)

    async def _once(self, holds: Callable[[], bool]) -> None:
        """Wait for the message after which a condition holds."""
        async with asyncio.timeout(PATIENCE_S):
            while not holds():
                self._told.clear()
                await self._told.wait()

    async def _send(self, message: Message) -> None:
        if message["type"] == "websocket.close":
            self.closed_with = message["code"]
        elif message["type"] == "websocket.http.response.start":
            self.answered = message
        elif message["type"] == "websocket.send":
            said = json.loads(message["text"])
            self.last[said["kind"]] = said
            if self.keep_all:
                self.heard.append(said)
            self._told.set()
