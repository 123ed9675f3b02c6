"""The clients of a loaded server: viewers, hands that drag corners, and programs that ask for plans.

All of them are coroutines of one loop, so that they take little of the machine from the server that they measure. As
a page does, a hand sends its next drawing only after the answer to the last.
"""

import asyncio
import itertools
import json
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from math import cos, sin, tau
from statistics import median, quantiles
from typing import Any, Final
from urllib.parse import urlsplit

import httpx
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

EDITS_PER_S: Final = 10.0
STROKE: Final = 20
"""Edits after which a hand releases a corner."""

RADIUS_M: Final = 0.01
PATIENCE_S: Final = 120.0
PLAN_LIMIT_S = 5.0
"""Time limit of each plan that is asked for (s)."""

_IDLE_S = 2.0
"""Time after which an idle connection is given up (s): the server waits 5 s, and might close one just used again."""

_CONFLICT = 409


@dataclass(slots=True)
class Heard:
    """The answers to the clients, and their times.

    Attributes:
        edits_ms: for each edit, the time from when the hand was there to its answer (ms).
        edits: the number of edits by HTTP status.
        plans_s: for each plan that was asked for, how long its answer took (s).
        plans: the number of these by HTTP status.
        messages: the number of messages that the viewers were sent.
        size: their size (bytes).
    """

    edits_ms: list[float] = field(default_factory=list)
    edits: Counter[int] = field(default_factory=Counter)
    plans_s: list[float] = field(default_factory=list)
    plans: Counter[int] = field(default_factory=Counter)
    messages: int = 0
    size: int = 0

    def edit_figures(self) -> dict[str, float]:
        """Return the median of the edits' times, what 95 % and 99 % keep to, and the most (ms)."""
        cuts = quantiles(self.edits_ms, n=100, method="inclusive")
        return {"median": median(self.edits_ms), "p95": cuts[94], "p99": cuts[98], "most": max(self.edits_ms)}


def client(url: str) -> httpx.AsyncClient:
    """Return a client that opens as many connections as it needs."""
    limits = httpx.Limits(max_connections=None, max_keepalive_connections=64, keepalive_expiry=_IDLE_S)
    return httpx.AsyncClient(base_url=url, timeout=PATIENCE_S, limits=limits, trust_env=False)


async def view(url: str, document: str, is_there: asyncio.Event, heard: Heard) -> None:
    """Follow a document as its page does, until cancelled; set the event once its drawing has come."""
    address = f"ws://{urlsplit(url).netloc}/api/documents/{document}/live"
    async with connect(address, proxy=None, max_size=None, compression=None) as page:
        with suppress(ConnectionClosed):
            async for message in page:
                heard.messages += 1
                heard.size += len(message)
                is_there.set()


async def drag(server: httpx.AsyncClient, document: dict[str, Any], until_s: float, heard: Heard) -> None:
    """Drag corner after corner of a document in a circle."""
    drawing, version = document["drawing"], document["version"]
    next_s = time.monotonic()
    for number in itertools.count():
        due_s = max(next_s, time.monotonic() - 1.0 / EDITS_PER_S)  # drawings that were overtaken are never sent
        if due_s > until_s:
            return
        await asyncio.sleep(max(0.0, due_s - time.monotonic()))
        stroke, step = divmod(number, STROKE)
        edit = {
            "base_version": version,
            "label": "Drag",
            "phase": "commit" if step == STROKE - 1 else "preview",
            "drawing": circled(drawing, stroke, tau * step / STROKE),
            "gesture": str(stroke),
        }
        answer = await server.put(f"/api/documents/{document['id']}/drawing", json=edit)
        heard.edits_ms.append(1e3 * (time.monotonic() - due_s))
        heard.edits[answer.status_code] += 1
        if answer.status_code in (httpx.codes.OK, _CONFLICT):
            told = answer.json()
            version = told["version"] if answer.status_code == httpx.codes.OK else told["state"]["version"]
        next_s = due_s + 1.0 / EDITS_PER_S


def circled(drawing: dict[str, Any], stroke: int, turned: float) -> dict[str, Any]:
    """Return a drawing with the corner of a stroke moved along its circle by an angle (rad)."""
    moved: dict[str, Any] = json.loads(json.dumps(drawing))
    corner = moved["outline"][stroke % len(moved["outline"])]
    x, y = corner["point"]
    corner["point"] = [x + RADIUS_M * (cos(turned) - 1.0), y + RADIUS_M * sin(turned)]
    return moved


async def ask_for_plans(
    server: httpx.AsyncClient, garments: Sequence[str], plans_per_s: float, until_s: float, heard: Heard
) -> None:
    """Request plans at a steady rate, without waiting for answers; return when all are answered."""
    kinds, next_s = itertools.cycle(garments), time.monotonic()
    async with asyncio.TaskGroup() as asking:
        while next_s < until_s:
            asking.create_task(_plan(server, next(kinds), heard))
            next_s += 1.0 / plans_per_s
            await asyncio.sleep(max(0.0, next_s - time.monotonic()))


async def _plan(server: httpx.AsyncClient, garment: str, heard: Heard) -> None:
    began_s = time.monotonic()
    answer = await server.post("/api/plans", json={"garment": garment, "time_limit_s": PLAN_LIMIT_S})
    heard.plans_s.append(time.monotonic() - began_s)
    heard.plans[answer.status_code] += 1
