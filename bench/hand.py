"""The latency of a drag: a corner of a garment is dragged by a centimetre in the page, with the robot at rest.

The page itself keeps the time (`bench.hand_page`): from each movement of the mouse to the corner drawn there, and from
the release to the status of the plan for the dropped drawing. Browser and server share the machine. Where the browser
draws the 3D view by software, a frame of the page takes as long as that, so the drags are also measured without it.
The corners and directions are those of `bench.re_plan`; each drag is undone before the next.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import cos, sin
from statistics import median, quantiles
from typing import Any

from bench.paper import TABLE_2
from bench.re_plan import MOVES, QUICK_MOVES, STEP_M, chosen
from bench.report import ABSENT, Report, Row
from bench.served import ask, cpu_s, served

COLUMNS = (
    "garment",
    "view3d",
    "drags",
    "ghost [ms]",
    "p95",
    "in frame",
    "plan [ms]",
    "p95",
    "most",
    "CPU [ms]",
    "solved",
    "other",
)
VIEWS = {False: "left out", True: "by software"}
NO_BROWSER = "no browser"


@dataclass(frozen=True, slots=True)
class Dragged:
    """The measurements of one drag.

    Attributes:
        to_ghost_ms: from each movement to its drawing (ms).
        same_frame: for each movement, whether the next frame showed it.
        to_plan_ms: from the release to the plan's status on the page (ms).
        server_cpu_ms: CPU time of the server from the press on (ms); None where the system does not report it.
        status: the plan's status.
    """

    to_ghost_ms: tuple[float, ...]
    same_frame: tuple[bool, ...]
    to_plan_ms: float
    server_cpu_ms: float | None
    status: str


def hand(garments: Sequence[str], repetitions: int) -> Report:
    """Measure the nine garments and, in the last row, all drags together; one row says so without a browser."""
    drags = MOVES if repetitions > 1 else QUICK_MOVES
    asked = [garment for garment in TABLE_2 if garment in garments]
    title = f"In the page: a corner dragged by {100 * STEP_M:g} cm, from the hand to what is seen"
    rows = tuple(_rows(asked, drags)) if asked else ()
    return Report("hand", title, COLUMNS, rows, 1)


def _rows(garments: Sequence[str], drags: int) -> Iterator[Row]:
    try:
        from playwright.sync_api import Error

        found = {garment: [drags_of(garment, drags, has_view=is_there) for is_there in VIEWS] for garment in garments}
    except ImportError:
        yield _absent("Playwright is not installed")
        return
    except Error as error:
        yield _absent(str(error).splitlines()[0])
        return
    for garment, runs in found.items():
        yield _row(garment, runs)
    if len(found) > 1:
        yield _row("all", [[one for dragged in runs for one in dragged] for runs in zip(*found.values(), strict=True)])


def drags_of(garment: str, drags: int, *, has_view: bool) -> list[Dragged]:
    """Return the measurements of drags of a garment's corners, in a server and a browser of their own."""
    from bench.hand_page import window

    with served() as (url, process):
        document = ask("POST", f"{url}/api/documents", {"garment": garment})
        path, corners = f"{url}/api/documents/{document['id']}", document["drawing"]["outline"]
        with window(f"{url}/d/{document['id']}", has_view=has_view) as page:
            moves = chosen(garment, len(corners), drags)
            return [_dragged(page, path, process.pid, *move) for move in moves]


def _dragged(page: Any, path: str, pid: int, corner: int, towards_rad: float) -> Dragged:  # noqa: ANN401
    from bench.hand_page import drag, grasp, heard, wait_for_answer, wait_for_rest

    wait_for_answer(page, ask("GET", path)["version"])
    x, y, scale = grasp(page, corner)
    wait_for_rest(page)
    before_s = cpu_s(pid)
    drag(page, (x, y), (STEP_M * cos(towards_rad) * scale, -STEP_M * sin(towards_rad) * scale))
    while (state := ask("GET", path))["gesture"] is not None or state["history"]["can_undo"] is None:
        page.wait_for_timeout(5.0)
    wait_for_answer(page, state["version"])
    after_s, kept = cpu_s(pid), heard(page, state["version"])
    ask("POST", f"{path}/undo")
    cpu_ms = None if before_s is None or after_s is None else 1e3 * (after_s - before_s)
    return Dragged(kept.to_ghost_ms, kept.same_frame, kept.to_plan_ms, cpu_ms, kept.status)


def _row(garment: str, runs: Sequence[Sequence[Dragged]]) -> Row:
    summaries = [_summary(dragged) for dragged in runs]
    lines: list[tuple[str, ...]] = []
    for view, found in zip(VIEWS.values(), summaries, strict=True):
        ghost, plan, cpu_ms = found["to_ghost_ms"], found["to_plan_ms"], found["server_cpu_ms"]
        cells = (
            f"{ghost['median']:.1f}",
            f"{ghost['p95']:.1f}",
            f"{100 * found['same_frame']:.0f} %",
            *(f"{plan[part]:.0f}" for part in ("median", "p95", "most")),
            ABSENT if cpu_ms is None else f"{cpu_ms:.0f}",
            str(found["solved"]),
            str(found["drags"] - found["solved"]),
        )
        lines.append(("" if lines else garment, view, str(found["drags"]), *cells))
    return Row(tuple(lines), {"garment": garment, **dict(zip(VIEWS.values(), summaries, strict=True))})


def _summary(dragged: Sequence[Dragged]) -> dict[str, Any]:
    ghosts = [time_ms for one in dragged for time_ms in one.to_ghost_ms]
    same = [is_same for one in dragged for is_same in one.same_frame]
    cpu = [one.server_cpu_ms for one in dragged if one.server_cpu_ms is not None]
    return {
        "drags": len(dragged),
        "to_ghost_ms": {**_spread(ghosts), "count": len(ghosts)},
        "same_frame": sum(same) / len(same),
        "to_plan_ms": _spread([one.to_plan_ms for one in dragged]),
        "server_cpu_ms": median(cpu) if cpu else None,
        "solved": sum(one.status == "solved" for one in dragged),
    }


def _absent(why: str) -> Row:
    line = (NO_BROWSER, *(ABSENT for _ in COLUMNS[1:]))
    return Row((line,), {"garment": None, "missing": why})


def _spread(values: Sequence[float]) -> dict[str, float]:
    p95 = quantiles(values, n=20, method="inclusive")[-1] if len(values) > 1 else values[0]
    return {"median": median(values), "p95": p95, "most": max(values)}
