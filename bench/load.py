"""The server under load: many open documents and viewers, hands that drag, and more plans asked for than it can make.

Twenty documents are open and followed by fifty viewers; in three of them a hand drags corners, ten drawings a second;
twenty plans a second are asked for, which is more than two cores can make, so that some are refused by 503. Each edit
is timed from the moment when the hand was there. Memory is that of the server's process, and that of all its
processes. At the end everybody leaves, and the table says what is still open when the documents have been closed.
"""

import asyncio
import itertools
import os
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from statistics import mean, median
from typing import Any

import httpx

from bench.crowd import DRAGGED
from bench.load_clients import EDITS_PER_S, Heard, ask_for_plans, client, drag, view
from bench.paper import TABLE_2
from bench.processes import cpu_s, family, memory_mb, sockets
from bench.report import Report, Row
from bench.served import served

COLUMNS = (
    "minutes",
    "edits",
    "of those wanted",
    "median [ms]",
    "p95",
    "p99",
    "most",
    "plans",
    "refused",
    "memory at first [MB]",
    "at the end",
    "left open",
    "load",
)
OPEN, VIEWERS, PLANS_PER_S = 20, 50, 20.0
MINUTES, MINUTES_QUICK = 1.0, 0.1
FIRST_S = 60.0
"""Time after which memory is to grow no more (s)."""

CLOSED_WITHIN_S = 120.0
"""Time after which unused documents have been closed (s)."""

_REFUSED = (429, 503)
_BESIDE = 5
"""Samples of the memory, one a second, whose mean is told."""


@dataclass(slots=True)
class Loaded:
    """The measurements of one load.

    Attributes:
        heard: what the clients were answered.
        memory_mb: the memory of the server's process, second by second (MB).
        all_memory_mb: that of all its processes (MB).
        cpu_share: the share of one core that the server's process took.
        left_open: what was open at the end and not before the load: documents, sockets, processes.
        load: the processes that wanted a core, as the system says in the end.
    """

    heard: Heard = field(default_factory=Heard)
    memory_mb: list[float] = field(default_factory=list)
    all_memory_mb: list[float] = field(default_factory=list)
    cpu_share: float = 0.0
    left_open: dict[str, int] = field(default_factory=dict)
    load: float = 0.0


def load(garments: Sequence[str], repetitions: int, minutes: float | None = None) -> Report:
    """Load a server with documents and plans of the garments.

    Args:
        garments: the garments' names; those that are not the paper's are left out.
        repetitions: 1 for a short load.
        minutes: how long the load lasts.
    """
    asked = [garment for garment in TABLE_2 if garment in garments]
    lasts = minutes or (MINUTES if repetitions > 1 else MINUTES_QUICK)
    title = f"{OPEN} open documents, {VIEWERS} viewers, {PLANS_PER_S:g} plans a second, edits in {DRAGGED} documents"
    rows: tuple[Row, ...] = ()
    if asked:
        with served() as (url, process):
            rows = (_row(lasts, asyncio.run(loaded(url, process.pid, asked, 60.0 * lasts))),)
    return Report("load", title, COLUMNS, rows, 1)


async def loaded(url: str, pid: int, garments: Sequence[str], duration_s: float) -> Loaded:
    """Load the server of a process for a duration (s), and wait until all is closed again."""
    found = Loaded()
    async with client(url) as server:
        (await server.post("/api/plans", json={"garment": garments[0]})).raise_for_status()  # all is loaded then
        before = await _open(server, pid)
        kinds = itertools.cycle(garments)
        documents = [(await server.post("/api/documents", json={"garment": next(kinds)})).json() for _ in range(OPEN)]
        viewers = await _viewers(url, [document["id"] for document in documents], found.heard)
        until_s, began_s = time.monotonic() + duration_s, cpu_s(pid)
        watching = asyncio.create_task(_watch(pid, found))
        async with asyncio.TaskGroup() as work:
            for document in documents[:DRAGGED]:
                work.create_task(drag(server, document, until_s, found.heard))
            work.create_task(ask_for_plans(server, garments, PLANS_PER_S, until_s, found.heard))
        found.cpu_share = (cpu_s(pid) - began_s) / duration_s
        found.load = os.getloadavg()[0]
        for task in (watching, *viewers):
            task.cancel()
        await asyncio.gather(watching, *viewers, return_exceptions=True)
    await asyncio.sleep(1.0)
    found.left_open = await _left_open(url, pid, before)
    return found


async def _viewers(url: str, documents: Sequence[str], heard: Heard) -> list[asyncio.Task[None]]:
    """Return the viewers of the documents, once all see them."""
    signs = [asyncio.Event() for _ in range(VIEWERS)]
    turns = zip(signs, itertools.cycle(documents))
    viewers = [asyncio.create_task(view(url, document, is_there, heard)) for is_there, document in turns]
    await asyncio.gather(*(is_there.wait() for is_there in signs))
    return viewers


async def _watch(pid: int, found: Loaded) -> None:
    """Note the memory every second."""
    while True:
        found.memory_mb.append(memory_mb(pid))
        found.all_memory_mb.append(sum(memory_mb(one) for one in family(pid)))
        await asyncio.sleep(1.0)


async def _left_open(url: str, pid: int, before: Counter[str]) -> dict[str, int]:
    """Return by how much more is open than before, as soon as that is nothing, or after `CLOSED_WITHIN_S`."""
    until_s = time.monotonic() + CLOSED_WITHIN_S
    while True:
        async with client(url) as server:
            left = await _open(server, pid)
        left.subtract(before)
        if all(count <= 0 for count in left.values()) or time.monotonic() > until_s:
            return {what: max(count, 0) for what, count in left.items()}
        await asyncio.sleep(2.0)


async def _open(server: httpx.AsyncClient, pid: int) -> Counter[str]:
    """Return how many sockets and processes are open now, and how many documents beyond the first, which is shown."""
    figures = (await server.get("/metrics")).text.splitlines()
    documents = next(float(line.split()[1]) for line in figures if line.startswith("pleat_open_documents "))
    return Counter(documents=int(documents), sockets=sockets(pid), processes=len(family(pid)))


def _row(minutes: float, found: Loaded) -> Row:
    heard, wanted = found.heard, DRAGGED * EDITS_PER_S * 60.0 * minutes
    edits = heard.edit_figures()
    refused = sum(heard.plans[status] for status in _REFUSED)
    first, last = (_memory(found.memory_mb, end) for end in (_first(found.memory_mb), len(found.memory_mb)))
    line = (
        f"{minutes:g}",
        str(len(heard.edits_ms)),
        f"{100 * len(heard.edits_ms) / wanted:.0f} %",
        *(f"{edits[part]:.0f}" for part in ("median", "p95", "p99", "most")),
        str(heard.plans.total()),
        f"{100 * refused / max(heard.plans.total(), 1):.0f} %",
        f"{first:.0f}",
        f"{last:.0f}",
        str(sum(found.left_open.values())),
        f"{found.load:.1f}",
    )
    data: dict[str, Any] = {
        "minutes": minutes,
        "edits": len(heard.edits_ms),
        "edits_wanted": wanted,
        "edit_ms": edits,
        "edits_by_status": dict(heard.edits),
        "plans": heard.plans.total(),
        "plans_by_status": dict(heard.plans),
        "plan_s": median(heard.plans_s),
        "messages": heard.messages,
        "messages_mb": heard.size / 1e6,
        "cpu_share": found.cpu_share,
        "memory_mb": found.memory_mb,
        "all_memory_mb": found.all_memory_mb,
        "memory_first_mb": first,
        "memory_last_mb": last,
        "left_open": found.left_open,
        "load": found.load,
    }
    return Row((line,), data)


def _first(samples: Sequence[float]) -> int:
    """Return the number of samples of the first minute, or of half the time where that is less."""
    return max(min(int(FIRST_S), len(samples) // 2), 1)


def _memory(samples: Sequence[float], end: int) -> float:
    """Return the mean of the last samples before an end (MB)."""
    return mean(samples[max(end - _BESIDE, 0) : end])
