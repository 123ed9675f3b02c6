"""The time that an edit takes while many documents are open, some are dragged, and others ask for plans.

Twenty documents are open, each followed by a page's websocket. In three of them a simulated hand drags a corner in a
circle: every tenth of a second it sends the drawing, and after two seconds it releases the corner and takes the next.
Like a page, a hand sends its next drawing only after the answer to the last. Then this is repeated while five plans a
second are requested, each of which may take five seconds. Each edit is timed from the moment when the hand was there,
which may be earlier than when the edit was sent.
"""

import http.client
import itertools
import json
import threading
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from math import cos, sin, tau
from statistics import median, quantiles
from typing import Any
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from bench.paper import TABLE_2
from bench.report import Report, Row
from bench.served import ask, served

COLUMNS = (
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
OPEN = 20
DRAGGED = 3
EDITS_PER_S = 10.0
PLANS_PER_S = 5.0
PLAN_LIMIT_S = 5.0
STROKE = 20
"""Edits after which a hand releases a corner."""

RADIUS_M = 0.01
DURATION_S = 15.0
QUICK_S = 2.0
PATIENCE_S = 120.0


@dataclass(slots=True)
class Heard:
    """The measurements of a crowd.

    Attributes:
        edits_ms: for each edit, how long it took (ms).
        plans_s: for each plan that was answered, how long that took (s).
        statuses: the number of plan requests by HTTP status.
    """

    edits_ms: list[float] = field(default_factory=list)
    plans_s: list[float] = field(default_factory=list)
    statuses: Counter[int] = field(default_factory=Counter)


def crowd(articles: Sequence[str], repetitions: int) -> Report:
    """Measure documents of the articles, with plans and without."""
    asked = [article for article in TABLE_2 if article in articles]
    title = f"Edits in {DRAGGED} of {OPEN} open documents, {EDITS_PER_S:g} a second each"
    duration_s = DURATION_S if repetitions > 1 else QUICK_S
    rows = (
        tuple(_row(rate, crowded(asked, duration_s, rate), duration_s) for rate in (0.0, PLANS_PER_S)) if asked else ()
    )
    return Report("crowd", title, COLUMNS, rows, 1)


def crowded(articles: Sequence[str], duration_s: float, plans_per_s: float) -> Heard:
    """Run a crowd on a server of its own for a duration (s), and return its measurements."""
    heard = Heard()
    with served() as (url, _), ExitStack() as pages:
        kinds = itertools.cycle(articles)
        documents = [ask("POST", f"{url}/api/documents", {"garment": next(kinds)}) for _ in range(OPEN)]
        for document in documents:
            pages.enter_context(_followed(url, document["id"]))
        time.sleep(min(duration_s, 5.0))  # until the first plans are there
        until_s = time.monotonic() + duration_s
        work = [partial(_drag, url, document, until_s, heard) for document in documents[:DRAGGED]]
        if plans_per_s:
            work.append(partial(_ask_for_plans, url, articles, plans_per_s, until_s, heard))
        threads = [threading.Thread(target=one, daemon=True) for one in work]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    return heard


@contextmanager
def _followed(url: str, document: str) -> Iterator[None]:
    """Keep a page's websocket to a document open, and read what comes."""
    with connect(f"ws://{urlsplit(url).netloc}/api/documents/{document}/live", proxy=None, max_size=None) as page:

        def read() -> None:
            with suppress(ConnectionClosed, OSError):
                for _ in page:
                    pass

        threading.Thread(target=read, daemon=True).start()
        yield


def _drag(url: str, document: dict[str, Any], until_s: float, heard: Heard) -> None:
    """Drag corner after corner in a circle."""
    drawing, version = document["drawing"], document["version"]
    next_s = time.monotonic()
    with closing(http.client.HTTPConnection(urlsplit(url).netloc, timeout=PATIENCE_S)) as wire:
        for number in itertools.count():
            due_s = max(next_s, time.monotonic() - 1.0 / EDITS_PER_S)  # drawings that were overtaken are never sent
            if due_s > until_s:
                return
            time.sleep(max(0.0, due_s - time.monotonic()))
            stroke, step = divmod(number, STROKE)
            edit = {
                "base_version": version,
                "label": "Drag",
                "phase": "commit" if step == STROKE - 1 else "preview",
                "drawing": circled(drawing, stroke, tau * step / STROKE),
                "gesture": str(stroke),
            }
            status, told = _sent(wire, "PUT", f"/api/documents/{document['id']}/drawing", edit)
            version = told["version"] if status == http.client.OK else told["state"]["version"]
            heard.edits_ms.append(1e3 * (time.monotonic() - due_s))
            next_s = due_s + 1.0 / EDITS_PER_S


def circled(drawing: dict[str, Any], stroke: int, turned: float) -> dict[str, Any]:
    """Return a drawing with the corner of a stroke moved along its circle by an angle (rad)."""
    moved: dict[str, Any] = json.loads(json.dumps(drawing))
    corner = moved["outline"][stroke % len(moved["outline"])]
    x, y = corner["point"]
    corner["point"] = [x + RADIUS_M * (cos(turned) - 1.0), y + RADIUS_M * sin(turned)]
    return moved


def _ask_for_plans(url: str, articles: Sequence[str], plans_per_s: float, until_s: float, heard: Heard) -> None:
    """Request plans at a steady rate, without waiting for answers."""
    kinds, asking = itertools.cycle(articles), []
    while time.monotonic() < until_s:
        asking.append(threading.Thread(target=_plan, args=(url, next(kinds), heard), daemon=True))
        asking[-1].start()
        time.sleep(1.0 / plans_per_s)
    for thread in asking:
        thread.join(PATIENCE_S)


def _plan(url: str, article: str, heard: Heard) -> None:
    began_s, wanted = time.monotonic(), {"garment": article, "time_limit_s": PLAN_LIMIT_S}
    with closing(http.client.HTTPConnection(urlsplit(url).netloc, timeout=PATIENCE_S)) as wire:
        status, _ = _sent(wire, "POST", "/api/plans", wanted)
    heard.plans_s.append(time.monotonic() - began_s)
    heard.statuses[status] += 1


def _sent(wire: http.client.HTTPConnection, method: str, path: str, body: object) -> tuple[int, dict[str, Any]]:
    """Send JSON; return the status and the JSON answer."""
    wire.request(method, path, json.dumps(body), {"content-type": "application/json"})
    answer = wire.getresponse()
    return answer.status, json.loads(answer.read())


def _row(plans_per_s: float, heard: Heard, duration_s: float) -> Row:
    wanted = DRAGGED * EDITS_PER_S * duration_s
    cuts = quantiles(heard.edits_ms, n=100, method="inclusive")
    edits = {"median": median(heard.edits_ms), "p95": cuts[94], "p99": cuts[98], "most": max(heard.edits_ms)}
    refused = heard.statuses.total() - heard.statuses[http.client.OK]
    name = f"{plans_per_s:g} plans a second" if plans_per_s else "nothing else"
    plan_s = median(heard.plans_s) if heard.plans_s else None
    line = (
        name,
        str(len(heard.edits_ms)),
        f"{100 * len(heard.edits_ms) / wanted:.0f} %",
        *(f"{edits[part]:.0f}" for part in ("median", "p95", "p99", "most")),
        str(heard.statuses.total()),
        "-" if plan_s is None else f"{plan_s:.2f}",
        str(refused),
    )
    data = {
        "plans_per_s": plans_per_s,
        "edits": len(heard.edits_ms),
        "edits_wanted": wanted,
        "edit_ms": edits,
        "plans": heard.statuses.total(),
        "plan_s": plan_s,
        "plans_refused": refused,
    }
    return Row((line,), data)
