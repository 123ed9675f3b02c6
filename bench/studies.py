"""Studies against plain loops: cells a second with one worker and with two, CPU time a cell, memory as cells go by.

All plan the same small tasks, starting with no kernel loaded, processes with no process either; a study also makes its
cells, keeps each answer on the disk, and writes table and report. They take turns. CPU time is that of all
processes of each, since a busy machine delays the one that happens to run.
"""

import multiprocessing
import os
import tempfile
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter

from app.studies.answer import Answer
from app.studies.cell import Cell
from app.studies.garment_entries import Sources
from app.studies.results import Results
from app.studies.run_study import run_study
from app.studies.study import Study
from app.studies.study_file import study_of
from app.studies.workers import LocalWorkers, Workers, cluster, planner
from bench.processes import cpu_s, family, memory_mb
from bench.report import Report, Row
from planner.task.task import Task

WORKERS = (1, 2)
COLUMNS = (
    "workers",
    "cells",
    "cells/s",
    "CPU ms a cell",
    "beyond the loop",
    "memory after 10 % [MB]",
    "at the end",
)
CELLS, CELLS_QUICK = 100, 40
"""Cells that each way plans in each turn: with three turns, 1,800 plans."""

_context = multiprocessing.get_context("forkserver")


@dataclass(frozen=True, slots=True)
class Run:
    """The measurements of planning all cells once: elapsed time, CPU time of all processes (s), largest memory (MB)."""

    wall_s: float
    cpu_s: float
    memory_mb: tuple[float, ...] = ()


class Watched:
    """Workers that note the CPU time of all processes, and their memory, while they answer."""

    def __init__(self, workers: Workers, every: int) -> None:
        """Note the memory after this many answers each."""
        self._workers = workers
        self._every = every
        self.memory_mb: list[float] = []
        self.cpu_s = 0.0

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        """Yield the answers."""
        for count, answer in enumerate(self._workers.answers(cells, keep_plans=keep_plans), 1):
            if count % self._every == 0:
                self.memory_mb.append(sum(memory_mb(pid) for pid in family(os.getpid())))
                self.cpu_s = sum(cpu_s(pid) for pid in family(os.getpid()))
            yield answer


def studies(_garments: Sequence[str], repetitions: int) -> Report:
    """Measure plain loops and studies, with one worker and with two, in turns."""
    asked = small_study(CELLS if repetitions > 1 else CELLS_QUICK)
    ways: dict[str, Callable[[], Run]] = {
        f"{name}, {workers}": partial(way, asked, workers)
        for workers in WORKERS
        for name, way in (("plain loop", plain_loop), ("processes", in_processes), ("local cluster", on_a_cluster))
    }
    turns = [{name: way() for name, way in ways.items()} for _ in range(min(repetitions, 3))]
    loops = {str(workers): median(turn[f"plain loop, {workers}"].cpu_s for turn in turns) for workers in WORKERS}
    rows = [study_row(name, asked.count, [turn[name] for turn in turns], loops[name.split(", ")[1]]) for name in ways]
    title = "Studies in processes and on a local cluster, and plain loops, with so many workers"
    return Report("studies", title, COLUMNS, tuple(rows), len(turns))


def small_study(cells: int) -> Study:
    """Return a study of small towels of many sizes at many heights."""
    measures = {"width_m": {"from": 0.3, "to": 0.5, "count": 5}, "length_m": {"from": 0.2, "to": 0.4, "count": 2}}
    return study_of(
        {
            "garments": [{"template": "towel", "measures": measures}],
            "table": {"height_m": {"from": 0.6, "to": 0.9, "count": max(cells // 20, 1)}},
            "limits": {"comfort_radius_m": [0.0, 0.03], "work_limit_s": 1.0},
        },
        Sources(),
    )


def in_processes(asked: Study, workers: int) -> Run:
    """Run a study in processes of its own."""
    return whole_study(asked, LocalWorkers(workers))


def on_a_cluster(asked: Study, workers: int) -> Run:
    """Run a study on a Dask cluster of this machine, which stands already."""
    from distributed import LocalCluster  # here, because it takes a second and only this needs it

    with (
        LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as local,
        cluster(local.scheduler_address) as executor,
    ):
        return whole_study(asked, executor)


def plain_loop(asked: Study, workers: int) -> Run:
    """Plan a study's tasks in processes, each a part, and keep nothing."""
    tasks = [cell.task for cell in asked.cells(asked.indices()) if cell.task is not None]
    began_s = perf_counter()
    pipes, processes = [], []
    for part in range(workers):
        ours, theirs = _context.Pipe(duplex=False)
        process = _context.Process(target=_plan_all, args=(theirs.send, tasks[part::workers]))
        process.start()
        theirs.close()
        pipes.append(ours)
        processes.append(process)
    cpu_s = sum(pipe.recv() for pipe in pipes)
    wall_s = perf_counter() - began_s
    for process in processes:
        process.join()
    return Run(wall_s, cpu_s)


def whole_study(asked: Study, workers: Workers) -> Run:
    """Run a study in a new folder."""
    watched = Watched(workers, max(asked.count // 10, 1))
    began_s, before_s = perf_counter(), sum(cpu_s(pid) for pid in family(os.getpid()))
    with tempfile.TemporaryDirectory() as folder, Results(Path(folder)) as results:
        results.begin(asked, resume=True)
        run_study(asked, results, watched, lambda _: None)
    return Run(perf_counter() - began_s, watched.cpu_s - before_s, tuple(watched.memory_mb))


def _plan_all(tell: Callable[[float], None], tasks: Sequence[Task]) -> None:
    make_plan = planner()
    for task in tasks:
        make_plan(task)
    tell(cpu_s(os.getpid()))


def study_row(name: str, cells: int, runs: Sequence[Run], loop_cpu_s: float) -> Row:
    """Return the row of one way to plan all cells, beside the CPU time of the plain loop with as many workers (s)."""
    wall_s, cpu_s = median(run.wall_s for run in runs), median(run.cpu_s for run in runs)
    beyond_ms = 1000 * (cpu_s - loop_cpu_s) / cells
    memory = max((run.memory_mb for run in runs), default=())
    shown = [f"{memory[0]:.0f}", f"{memory[-1]:.0f}"] if memory else ["-", "-"]
    line = (name, str(cells), f"{cells / wall_s:.1f}", f"{1000 * cpu_s / cells:.1f}", f"{beyond_ms:.1f}", *shown)
    data = {
        "name": name,
        "cells": cells,
        "wall_s": wall_s,
        "cpu_s": cpu_s,
        "beyond_loop_ms": beyond_ms,
        "memory_mb": list(memory),
    }
    return Row((line,), data)
