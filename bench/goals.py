"""How quick Pleat is meant to be, beside how quick it is: commands, plans in a fresh process, edits, many corners.

All times are CPU times of all processes that take part. Each is measured in a fresh process or repeated in turns, and
the least is given: the machine may be busy.
"""

import json
import math
import os
import resource
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from statistics import median
from time import process_time

from bench.paper import TABLE_2
from bench.processes import family, family_cpu_s
from bench.re_plan import ILLEGAL, replanned
from bench.report import Report, Row
from bench.served import ask, served
from planner import load_garment
from planner.cloth.garment import Garment

COLUMNS = ("what", "goal [ms]", "CPU [ms]", "times the goal")

COMMANDS = (
    (("--help",), 300.0),
    (("robots",), 300.0),
    (("export", "--list"), 300.0),
    (("plan", "vest"), 1_200.0),
)
"""Commands, and the goals of their CPU time (ms)."""

NINE_COLD_MS, NINE_KNOWN_MS = 1_000.0, 450.0
EDITS_MS = {"t-shirt": 60.0, "shirt": 90.0, "tie": 60.0}
REST_GARMENT, REST_AGAIN_MS, REST_NEW_MS, REST_NINE_MS = "vest", 40.0, 130.0, 1_400.0
"""A garment asked for over REST, and the goals for it, for others like it, and for the nine garments in turn."""

_REST_TIMES, _REST_STEP_M = 8, 0.002
"""Requests of each kind, and by how much each new garment lies further back than the one before (m)."""

CORNERS, CORNERS_MS = 400, 20.0

_NINE = """
import json, sys
from time import process_time
from planner import load_garment, make_plan
from planner.planning.warm_up import compile_kernels
compile_kernels("pr2")
garments = [load_garment(name) for name in sys.argv[1:]]
times = []
for _ in range(2):
    begun = process_time()
    for garment in garments:
        make_plan(garment)
    times.append(process_time() - begun)
print(json.dumps(times))
"""
"""A fresh process that plans some garments twice, with compiled kernels loaded."""


def goals(garments: Sequence[str], repetitions: int) -> Report:
    """Measure each goal; `garments` names those whose edits are measured."""
    rows = [_row(f"pleat {' '.join(command)}", goal, _command_ms(command, repetitions)) for command, goal in COMMANDS]
    cold_ms, known_ms = _nine_ms()
    rows += [
        _row("the nine garments, cold", NINE_COLD_MS, cold_ms),
        _row("the nine garments, known", NINE_KNOWN_MS, known_ms),
        _row(f"reading {CORNERS} corners", CORNERS_MS, _least_ms(_read_many_corners, repetitions)),
    ]
    rows += _rest_rows()
    for garment, goal in EDITS_MS.items():
        if garment in garments:
            first = [1e3 * one.first_cpu_s for one in replanned(garment, 8) if one.status != ILLEGAL]
            rows.append(_row(f"first plan after an edit: {garment}", goal, median(first)))
    return Report("goals", "CPU time beside its goal", COLUMNS, tuple(rows), repetitions)


def _row(what: str, goal_ms: float, took_ms: float) -> Row:
    cells = (what, f"{goal_ms:,.0f}", f"{took_ms:,.0f}", f"{took_ms / goal_ms:.1f}")
    return Row((cells,), {"what": what, "goal_ms": goal_ms, "cpu_ms": took_ms})


def _command_ms(command: Sequence[str], repetitions: int) -> float:
    """Return the CPU time of a command in a process of its own (ms)."""
    program = [sys.executable, "-c", "from app.cli import main; main()", *command]

    def run() -> None:
        subprocess.run(program, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "PYTHONSAFEPATH": ""})

    return _least_ms(run, repetitions, _children_s)


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _nine_ms() -> tuple[float, float]:
    """Return the CPU times of plans of the nine garments in a fresh process, and of the same again (ms)."""
    program = [sys.executable, "-c", _NINE, *TABLE_2]
    done = subprocess.run(program, check=True, capture_output=True, text=True)
    cold_s, known_s = json.loads(done.stdout)
    return 1e3 * cold_s, 1e3 * known_s


def _rest_rows() -> list[Row]:
    """Measure plans over REST, on a server that has planned once: server and workers together."""
    garment = load_garment(REST_GARMENT)
    new = [
        replace(garment, placement=garment.placement.moved(-_REST_STEP_M * number, 0.0)).to_dict()
        for number in range(1, _REST_TIMES + 1)
    ]
    with served() as (url, process):

        def took_ms(garments: Sequence[object]) -> float:
            before_s = family_cpu_s(family(process.pid))
            for one in garments:
                ask("POST", f"{url}/api/plans", {"garment": one})
            return 1e3 * (family_cpu_s(family(process.pid)) - before_s)

        took_ms([REST_GARMENT])
        again_ms, new_ms = (took_ms(some) / _REST_TIMES for some in ([REST_GARMENT] * _REST_TIMES, new))
        nine_ms = took_ms(list(TABLE_2))
    return [
        _row(f"{REST_GARMENT} by REST, planned before", REST_AGAIN_MS, again_ms),
        _row(f"{REST_GARMENT} by REST, new", REST_NEW_MS, new_ms),
        _row("the nine by REST, in turn", REST_NINE_MS, nine_ms),
    ]


def _read_many_corners() -> None:
    """Read a garment whose straight edges have many corners, as curves and photos make them."""
    corners = [(0.0, 0.0), (0.6, 0.0), (0.6, 0.4), (0.0, 0.4)]
    per_side = CORNERS // len(corners)
    outline = [
        [a[0] + (b[0] - a[0]) * i / per_side, a[1] + (b[1] - a[1]) * i / per_side]
        for a, b in pairwise([*corners, corners[0]])
        for i in range(per_side)
    ]
    Garment.from_dict({"name": "many-corners", "outline": outline})


def _least_ms(run: Callable[[], None], repetitions: int, clock_s: Callable[[], float] = process_time) -> float:
    least_s = math.inf
    for _ in range(max(2, repetitions)):
        begun_s = clock_s()
        run()
        least_s = min(least_s, clock_s() - begun_s)
    return 1e3 * least_s
