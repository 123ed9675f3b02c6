"""How long a user waits for the new plan after moving a corner of the outline by a centimetre.

Each article is planned as it is shipped; then corners are moved, one at a time and each from the shipped drawing: the
folds follow their ties, and what comes out is planned. What is kept from plan to plan (joint paths of what has not
changed) is kept here too, so no move is timed twice.
"""

import random
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, sin, tau
from statistics import median, quantiles
from time import perf_counter, thread_time

from app.drawing.drawing import Corner, Drawing
from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from bench.paper import TABLE_2
from bench.report import Report, Row
from planner import Plan, load_garment, make_plan
from planner.cloth.garment import Garment

COLUMNS = (
    "article",
    "moves",
    "CPU [ms]",
    "p95",
    "most",
    "wall [ms]",
    "p95",
    "search [ms]",
    "joints [ms]",
    "solved",
    "other",
)
MOVES = 8
"""So many corners of an article are moved; all of them where it has fewer."""

QUICK_MOVES = 1
STEP_M = 0.01
SEED = 1
ILLEGAL = "illegal"
"""Instead of a plan's status where the drawing is none any more after the move."""


@dataclass(frozen=True, slots=True)
class Replanned:
    """A new plan after a move.

    Attributes:
        corner: which corner was moved.
        status: the plan's, or that the drawing is illegal.
        cpu_s: CPU time from the move to the plan, solving the drawing included (s).
        wall_s: time that went by (s).
        search_time_s: the part of it spent searching (s).
        joint_time_s: the part of it spent on joint paths (s).
    """

    corner: int
    status: str
    cpu_s: float
    wall_s: float
    search_time_s: float
    joint_time_s: float


def re_plan(articles: Sequence[str], repetitions: int) -> Report:
    """The nine articles and, in the last row, all moves together."""
    moves = MOVES if repetitions > 1 else QUICK_MOVES
    found = {article: replanned(article, moves) for article in TABLE_2 if article in articles}
    rows = [_row(article, runs) for article, runs in found.items()]
    if len(found) > 1:
        rows.append(_row("all", [run for runs in found.values() for run in runs]))
    title = f"Re-plan after a corner has been moved by {100 * STEP_M:g} cm"
    return Report("re-plan", title, COLUMNS, tuple(rows), 1)


def replanned(article: str, moves: int) -> list[Replanned]:
    """So many moves of an article's corners, the same in every run, in directions the same in every run."""
    drawing = solve(drawing_of(load_garment(article))).drawing
    _plan(_garment(drawing), drawing)
    return [_replanned(drawing, *move) for move in chosen(article, len(drawing.outline), moves)]


def chosen(article: str, corners: int, moves: int) -> list[tuple[int, float]]:
    """Which of so many corners are moved, and in which direction (rad): the same in every run."""
    choice = random.Random(f"{SEED} {article}")
    return [(corner, choice.uniform(0.0, tau)) for corner in choice.sample(range(corners), min(moves, corners))]


def moved(drawing: Drawing, number: int, towards_rad: float) -> Drawing:
    """The drawing with one corner moved by `STEP_M`."""
    corner = drawing.outline[number]
    x, y = corner.point
    there = Corner(corner.id, (x + STEP_M * cos(towards_rad), y + STEP_M * sin(towards_rad)))
    return replace(drawing, outline=(*drawing.outline[:number], there, *drawing.outline[number + 1 :]))


def _replanned(drawing: Drawing, corner: int, towards_rad: float) -> Replanned:
    edited = moved(drawing, corner, towards_rad)
    wall, cpu = perf_counter(), thread_time()
    garment = solve(edited).garment
    plan = None if garment is None else _plan(garment, edited)
    cpu_s, wall_s = thread_time() - cpu, perf_counter() - wall
    if plan is None:
        return Replanned(corner, ILLEGAL, cpu_s, wall_s, 0.0, 0.0)
    spent = plan.statistics
    return Replanned(corner, plan.status, cpu_s, wall_s, spent.search_time_s, spent.joint_time_s)


def _garment(drawing: Drawing) -> Garment:
    garment = solve(drawing).garment
    assert garment is not None, drawing.name
    return garment


def _plan(garment: Garment, drawing: Drawing) -> Plan:
    return make_plan(
        garment,
        drawing.scene,
        start_station=drawing.start_station,
        comfort_radius_m=drawing.comfort_radius_m,
    )


def _row(name: str, runs: Sequence[Replanned]) -> Row:
    planned = [run for run in runs if run.status != ILLEGAL]
    parts = ("cpu_s", "wall_s", "search_time_s", "joint_time_s")
    cpu, wall, search, joints = (_spread([1e3 * getattr(run, part) for run in planned]) for part in parts)
    statuses = Counter(run.status for run in runs)
    solved = statuses["solved"]
    times_ms = (*cpu.values(), wall["median"], wall["p95"], search["median"], joints["median"])
    line = (name, str(len(runs)), *(f"{time_ms:.0f}" for time_ms in times_ms), str(solved), str(len(runs) - solved))
    data = {
        "article": name,
        "cpu_ms": cpu,
        "wall_ms": wall,
        "search_ms": search,
        "joint_ms": joints,
        "statuses": dict(statuses),
    }
    return Row((line,), data)


def _spread(values: Sequence[float]) -> dict[str, float]:
    """Median, 95th percentile and most; not a number without values."""
    if not values:
        return dict.fromkeys(("median", "p95", "most"), float("nan"))
    p95 = quantiles(values, n=20, method="inclusive")[-1] if len(values) > 1 else values[0]
    return {"median": median(values), "p95": p95, "most": max(values)}
