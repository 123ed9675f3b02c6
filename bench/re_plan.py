"""The wait for the new plan after a corner of the outline has moved by a centimetre.

Each garment is opened as a document and planned as it is shipped; then corners are moved, one at a time and each from
the shipped drawing: the folds follow their ties, and the new drawing is planned. Two moments are timed: when the first
plan for the new drawing is published, and when the search for a quicker one ends. State that a document keeps from plan
to plan (known plans, joint paths of what has not changed) is kept here too, so no move is made twice.
"""

import random
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from math import cos, sin, tau
from pathlib import Path
from statistics import median, quantiles
from tempfile import TemporaryDirectory
from time import perf_counter, process_time, sleep

from app.document import Document
from app.document_state import DocumentState
from app.drawing.draft import draft_of
from app.drawing.drawing import Corner, Drawing
from app.drawing.edit import Edit
from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.jobs.job_pool import JobPool
from app.replanner import Replanner
from app.store.database import Database
from app.store.plan_store import PlanStore
from bench.in_thread import InThread
from bench.paper import TABLE_2
from bench.report import Report, Row
from planner import load_garment

COLUMNS = (
    "garment",
    "moves",
    "first, CPU [ms]",
    "p95",
    "wall [ms]",
    "p95",
    "final, CPU [ms]",
    "p95",
    "soon",
    "solved",
)
MOVES = 8
"""Number of corners of a garment that are moved; all of them where it has fewer."""

QUICK_MOVES = 1
STEP_M = 0.01

_REST_S = 0.001
"""Time between two looks at whether the pool rests (s)."""

SEED = 1
ILLEGAL = "illegal"
"""Status of a move after which the drawing is not legal, in place of a plan's."""


@dataclass(frozen=True, slots=True)
class Replanned:
    """The measurements of a new plan after a move.

    Attributes:
        corner: the index of the corner moved.
        status: the final plan's status, or that the drawing is illegal.
        first_cpu_s: CPU time of all threads from the move to the first plan, solving the drawing included (s).
        first_wall_s: elapsed time from the move to the first plan (s).
        final_cpu_s: CPU time from the move to the end of the search for a quicker plan (s).
        is_soon: whether the first plan was adapted from earlier plans, not searched for.
    """

    corner: int
    status: str
    first_cpu_s: float
    first_wall_s: float
    final_cpu_s: float
    is_soon: bool


def re_plan(garments: Sequence[str], repetitions: int) -> Report:
    """Measure the nine garments and, in the last row, all moves together."""
    moves = MOVES if repetitions > 1 else QUICK_MOVES
    found = {garment: replanned(garment, moves) for garment in TABLE_2 if garment in garments}
    rows = [_row(garment, runs) for garment, runs in found.items()]
    if len(found) > 1:
        rows.append(_row("all", [run for runs in found.values() for run in runs]))
    title = f"Re-plan after a corner has been moved by {100 * STEP_M:g} cm"
    return Report("re-plan", title, COLUMNS, tuple(rows), 1)


def replanned(garment: str, moves: int) -> list[Replanned]:
    """Move corners of a garment and return the measurements; corners and directions are the same in every run."""
    return redrawn(drawing_of(load_garment(garment)), moves)


def redrawn(drawing: Drawing, moves: int) -> list[Replanned]:
    """Move corners of a drawing and return the measurements; corners and directions are the same in every run."""
    shipped = solve(drawing).drawing
    with _planned(shipped) as (document, pool):
        return [
            _replanned(document, pool, shipped, *move) for move in chosen(shipped.name, len(shipped.outline), moves)
        ]


def chosen(garment: str, corners: int, moves: int) -> list[tuple[int, float]]:
    """Return the corners to move and their directions (rad), the same in every run."""
    choice = random.Random(f"{SEED} {garment}")
    return [(corner, choice.uniform(0.0, tau)) for corner in choice.sample(range(corners), min(moves, corners))]


def moved(drawing: Drawing, number: int, towards_rad: float) -> Drawing:
    """Return the drawing with one corner moved by `STEP_M`."""
    corner = drawing.outline[number]
    x, y = corner.point
    there = Corner(corner.id, (x + STEP_M * cos(towards_rad), y + STEP_M * sin(towards_rad)))
    return replace(drawing, outline=(*drawing.outline[:number], there, *drawing.outline[number + 1 :]))


@contextmanager
def _planned(drawing: Drawing) -> Iterator[tuple[Document, JobPool]]:
    """Yield a document and the pool of its planner, both at rest."""
    document, pool = Document(draft_of(drawing)), JobPool()
    with TemporaryDirectory() as folder, closing(Database(Path(folder) / "pleat.db")) as database:
        replanner = Replanner(document, pool, InThread(), PlanStore(database))
        try:
            _rest(document, pool)
            yield document, pool
        finally:
            replanner.close()
            pool.close()


def _replanned(document: Document, pool: JobPool, drawing: Drawing, corner: int, towards_rad: float) -> Replanned:
    edited = moved(drawing, corner, towards_rad)
    wall, cpu = perf_counter(), process_time()
    state = document.edit(Edit("Move", edited))
    if state.solution.problems:
        first = final = document.state
        first_wall_s, first_cpu_s, final_cpu_s = perf_counter() - wall, process_time() - cpu, process_time() - cpu
    else:
        first = _until(document, lambda state: state.is_answered or state.failure is not None)
        first_wall_s, first_cpu_s = perf_counter() - wall, process_time() - cpu
        final = _until(document, _is_settled)
        final_cpu_s = process_time() - cpu
    is_soon = first.answer is not None and not first.answer.is_final
    status = ILLEGAL if final.solution.problems or final.answer is None else final.answer.plan.status
    document.edit(Edit("Back", drawing))
    _rest(document, pool)
    return Replanned(corner, status, first_cpu_s, first_wall_s, final_cpu_s, is_soon)


def _rest(document: Document, pool: JobPool) -> None:
    """Wait until the answer is final and what comes after it is done: a plan is written only after it is shown."""
    _until(document, _is_settled)
    while any(pool.load()[:2]):
        sleep(_REST_S)


def _is_settled(state: DocumentState) -> bool:
    """Return whether the answer is final, and played."""
    if state.failure is not None:
        return True
    if state.answer is None or not state.is_answered or not state.answer.is_final:
        return False
    return not state.answer.plan.is_solved or (state.shown is not None and state.shown.plan is state.answer.plan)


def _until(document: Document, condition: Callable[[DocumentState], bool]) -> DocumentState:
    """Return the first state seen that meets a condition."""
    changed = threading.Event()
    unsubscribe = document.subscribe(changed.set)
    try:
        while not condition(state := document.state):
            changed.wait()
            changed.clear()
        return state
    finally:
        unsubscribe()


def _row(name: str, runs: Sequence[Replanned]) -> Row:
    planned = [run for run in runs if run.status != ILLEGAL]
    parts = ("first_cpu_s", "first_wall_s", "final_cpu_s")
    first, wall, final = (_spread([1e3 * getattr(run, part) for run in planned]) for part in parts)
    statuses = Counter(run.status for run in runs)
    solved, soon = statuses["solved"], sum(run.is_soon for run in planned)
    times_ms = [spread[part] for spread in (first, wall, final) for part in ("median", "p95")]
    line = (name, str(len(runs)), *(f"{time_ms:.0f}" for time_ms in times_ms), str(soon), str(solved))
    data = {
        "garment": name,
        "moves": len(runs),
        "first_cpu_ms": first,
        "first_wall_ms": wall,
        "final_cpu_ms": final,
        "soon": soon,
        "statuses": dict(statuses),
    }
    return Row((line,), data)


def _spread(values: Sequence[float]) -> dict[str, float]:
    """Return median, 95th percentile and maximum; nan without values."""
    if not values:
        return dict.fromkeys(("median", "p95", "most"), float("nan"))
    p95 = quantiles(values, n=20, method="inclusive")[-1] if len(values) > 1 else values[0]
    return {"median": median(values), "p95": p95, "most": max(values)}
