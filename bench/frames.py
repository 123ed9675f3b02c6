"""The server's cost of one animation frame: without viewers, with one viewer, with ten.

A plan's whole timeline is shown at 30 frames a second, as the player does, once for each number of viewers, which are
real clients of the 3D view in a process of their own. A frame's server time is all CPU time that the server's process
spends from one frame to the next: computing the sample, writing it in the 3D view, and viser's own thread, which packs
it and sends it to each viewer.
"""

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median, quantiles
from time import perf_counter, process_time, sleep, thread_time
from typing import Any

from app.ui.view_3d import View3D
from bench.measurement import BenchmarkError, Ratio
from bench.report import Report, Row
from bench.viewers import READY
from planner import Plan, load_garment, make_plan
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot

COLUMNS = (
    "garment",
    "viewers",
    "frames",
    "make [ms]",
    "show [ms]",
    "p95",
    "server [ms]",
    "p95",
    "wall [ms]",
    "times none",
)
ROOT = Path(__file__).parent.parent
SAMPLE = ("t-shirt",)
VIEWERS = (0, 1, 10)
FRAMES_PER_S = 30.0
PATIENCE_S = 60.0

QUICK_EVERY = 20
"""Stride over the frames in a quick run."""


@dataclass(frozen=True, slots=True)
class Times:
    """The times of one frame (ms).

    Attributes:
        make_ms: CPU time of computing the frame.
        show_ms: CPU time of `View3D.show`.
        server_ms: CPU time of the whole process until the next frame.
        wall_ms: elapsed time from the start of making it to the end of showing it.
    """

    make_ms: float
    show_ms: float
    server_ms: float
    wall_ms: float


def frames(garments: Sequence[str], repetitions: int) -> Report:
    """Measure the T-shirt: every frame, or every twentieth in a quick run."""
    return frames_of([garment for garment in SAMPLE if garment in garments], 1 if repetitions > 1 else QUICK_EVERY)


def frames_of(garments: Sequence[str], every: int, viewers: Sequence[int] = VIEWERS) -> Report:
    """Measure every `every`-th frame of garments for each number of viewers; the first number is the baseline."""
    rows = []
    for garment in garments:
        plan = make_plan(load_garment(garment))
        if not plan.is_solved:
            raise BenchmarkError(f"{garment} has no plan to be shown")
        view = View3D(load_robot(plan.task.robot).card, plan.scene)
        try:
            view.show_plan(plan)
            rows.append(_row(garment, {count: _run(view, plan, count, every) for count in viewers}))
        finally:
            view.close()
    title = f"One animation frame, {FRAMES_PER_S:g} a second: CPU time of the server"
    return Report("frames", title, COLUMNS, tuple(rows), 1)


def _run(view: View3D, plan: Plan, viewers: int, every: int) -> tuple[list[Times], list[dict[str, int]]]:
    """Return the times of each frame of a plan, and what each viewer has read."""
    timeline = Timeline.of(plan)
    moments = [number * every / FRAMES_PER_S for number in range(int(timeline.duration_s * FRAMES_PER_S / every) + 1)]
    view.show(timeline.at(0.0))
    read: list[dict[str, int]] = []
    with _watched(view, viewers, read):
        times = list(_shown(view, plan, moments))
    return times, read


def _shown(view: View3D, plan: Plan, moments: Sequence[float]) -> Iterator[Times]:
    timeline, due_s = Timeline.of(plan), perf_counter()
    for t_s in moments:
        wall, whole, begun = perf_counter(), process_time(), thread_time()
        frame = timeline.at(t_s)
        made = thread_time()
        view.show(frame)
        shown, wall = thread_time(), perf_counter() - wall
        due_s = max(due_s + 1.0 / FRAMES_PER_S, perf_counter())
        sleep(due_s - perf_counter() if due_s > perf_counter() else 0.0)
        server = process_time() - whole
        yield Times(1e3 * (made - begun), 1e3 * (shown - made), 1e3 * server, 1e3 * wall)


@contextmanager
def _watched(view: View3D, viewers: int, read: list[dict[str, int]]) -> Iterator[None]:
    """Connect viewers within the context; at its end add what each of them has read to `read`."""
    if viewers == 0:
        yield
        return
    command = [sys.executable, "-m", "bench.viewers", str(view.port), view.secret, str(viewers)]
    with subprocess.Popen(command, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            if process.stdout.readline().strip() != READY:
                raise BenchmarkError("the viewers cannot watch")
            yield
            said, _ = process.communicate(timeout=PATIENCE_S)
            read.extend(json.loads(said))
        finally:
            process.kill()


def _row(garment: str, runs: dict[int, tuple[list[Times], list[dict[str, int]]]]) -> Row:
    (_, (unwatched, _)), *_ = runs.items()
    none_ms = [times.server_ms for times in unwatched]
    lines: list[tuple[str, ...]] = []
    data: list[dict[str, Any]] = []
    for viewers, (times, read) in runs.items():
        longer = Ratio.of([one.server_ms for one in times], none_ms)
        figures = {name: _summary([getattr(one, name) for one in times]) for name in Times.__slots__}
        data.append(_as_json(viewers, figures, longer, len(times), read))
        lines.append(
            (
                "" if lines else garment,
                str(viewers),
                str(len(times)),
                f"{figures['make_ms']['median']:.2f}",
                *(f"{figures['show_ms'][part]:.2f}" for part in ("median", "p95")),
                *(f"{figures['server_ms'][part]:.2f}" for part in ("median", "p95")),
                f"{figures['wall_ms']['median']:.2f}",
                f"{longer.median:.2f}",
            )
        )
    return Row(tuple(lines), {"garment": garment, "runs": data})


def _as_json(
    viewers: int, figures: dict[str, dict[str, float]], longer: Ratio, count: int, read: list[dict[str, int]]
) -> dict[str, Any]:
    return {"viewers": viewers, "frames": count, **figures, "server_ratio": asdict(longer), "read": read}


def _summary(values: Sequence[float]) -> dict[str, float]:
    return {"median": median(values), "p95": quantiles(values, n=20, method="inclusive")[-1]}
