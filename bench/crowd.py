"""The time that an edit takes while many documents are open, some are dragged, and others ask for plans.

Twenty documents are open, each followed by a page's websocket. In three of them a simulated hand drags a corner in a
circle: every tenth of a second it sends the drawing, and after two seconds it releases the corner and takes the next.
Like a page, a hand sends its next drawing only after the answer to the last. Then this is repeated while five plans a
second are requested, each of which may take five seconds. Each edit is timed from the moment when the hand was there,
which may be earlier than when the edit was sent.
"""

import asyncio
import itertools
import time
from collections.abc import Sequence
from statistics import median
from typing import Final

import httpx

from bench.load_clients import EDITS_PER_S, Heard, ask_for_plans, client, drag, view
from bench.paper import TABLE_2
from bench.report import Report, Row
from bench.served import served

COLUMNS: Final = (
    "meanwhile",
    "edits",
    "of those wanted",
    "median [ms]",
    "p95",
    "p99",
    "most",
    "plans",
    "median [s]",
    "refused",
)
OPEN: Final = 20
DRAGGED: Final = 3
PLANS_PER_S: Final = 5.0
DURATION_S: Final = 15.0
QUICK_S: Final = 2.0

_FIRST_PLANS_S = 5.0
"""Time for the first plans of the documents (s)."""


def crowd(garments: Sequence[str], repetitions: int) -> Report:
    """Measure documents of the garments, with plans and without."""
    asked = [garment for garment in TABLE_2 if garment in garments]
    title = f"Edits in {DRAGGED} of {OPEN} open documents, {EDITS_PER_S:g} a second each"
    duration_s = DURATION_S if repetitions > 1 else QUICK_S
    rates = (0.0, PLANS_PER_S) if asked else ()
    rows = tuple(_row(rate, asyncio.run(crowded(asked, duration_s, rate)), duration_s) for rate in rates)
    return Report("crowd", title, COLUMNS, rows, 1)


async def crowded(garments: Sequence[str], duration_s: float, plans_per_s: float) -> Heard:
    """Run a crowd on a server of its own for a duration (s), and return its measurements."""
    heard, kinds = Heard(), itertools.cycle(garments)
    with served() as (url, _):
        async with client(url) as server:
            documents = [
                (await server.post("/api/documents", json={"garment": next(kinds)})).json() for _ in range(OPEN)
            ]
            pages = [asyncio.create_task(view(url, document["id"], asyncio.Event(), Heard())) for document in documents]
            await asyncio.sleep(min(duration_s, _FIRST_PLANS_S))
            until_s = time.monotonic() + duration_s
            async with asyncio.TaskGroup() as work:
                for document in documents[:DRAGGED]:
                    work.create_task(drag(server, document, until_s, heard))
                if plans_per_s:
                    work.create_task(ask_for_plans(server, garments, plans_per_s, until_s, heard))
            for page in pages:
                page.cancel()
            await asyncio.gather(*pages, return_exceptions=True)
    return heard


def _row(plans_per_s: float, heard: Heard, duration_s: float) -> Row:
    wanted, edits = DRAGGED * EDITS_PER_S * duration_s, heard.edit_figures()
    refused = heard.plans.total() - heard.plans[httpx.codes.OK]
    name = f"{plans_per_s:g} plans a second" if plans_per_s else "nothing else"
    plan_s = median(heard.plans_s) if heard.plans_s else None
    line = (
        name,
        str(len(heard.edits_ms)),
        f"{100 * len(heard.edits_ms) / wanted:.0f} %",
        *(f"{edits[part]:.0f}" for part in ("median", "p95", "p99", "most")),
        str(heard.plans.total()),
        "-" if plan_s is None else f"{plan_s:.2f}",
        str(refused),
    )
    data = {
        "plans_per_s": plans_per_s,
        "edits": len(heard.edits_ms),
        "edits_wanted": wanted,
        "edit_ms": edits,
        "plans": heard.plans.total(),
        "plan_s": plan_s,
        "plans_refused": refused,
    }
    return Row((line,), data)
