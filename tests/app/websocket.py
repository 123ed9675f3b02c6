"""A page's websocket to a server without a network."""

import asyncio
import contextlib
import json
from typing import Any

from starlette.types import ASGIApp, Message

from tests.app.conftest import OWN_URL


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
        async with asyncio.timeout(60.0):
            while not wanted.items() <= self.last.get(kind, {"": None}).items() or kind not in self.last:
                await asyncio.sleep(0.002)
        return self.last[kind]

    async def until_planned(self, version: int) -> dict[str, Any]:
        """Wait for the final plan of a version, and for its playback; return the plan's message."""
        plan = await self.until("plan", status="solved", version=version)
        async with asyncio.timeout(60.0):
            while not (plan := self.last["plan"])["plan"]["is_final"]:
                await asyncio.sleep(0.002)
        await self.until("playback", version=version, duration_s=plan["plan"]["cost_s"])
        return plan

    async def hang_up(self) -> None:
        self._inbox.put_nowait({"type": "websocket.disconnect", "code": 1001})
        with contextlib.suppress(asyncio.CancelledError):
            await asyncio.wait_for(self._task, 10.0)

    async def has_ended(self) -> None:
        """Wait until the server has closed the connection, or has refused it."""
        await asyncio.wait_for(self._task, 60.0)

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
