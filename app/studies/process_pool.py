"""A pool of processes that outlives the death of its workers.

Each worker has a pipe of its own and two cells at most: the one under way and the next, so that it never waits for this
process. So it is known which cell a worker died of: that one is tried once more, the other is given to somebody else.
`concurrent.futures` gives up its whole pool in that case, and cannot end a cell that hangs.
"""

import math
import multiprocessing
import multiprocessing.connection
import os
import signal
import threading
import time
from collections import Counter, deque
from collections.abc import Generator, Iterable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from app.studies.answer import Answer, MakePlan, answered, failed
from app.studies.cell import Cell
from app.studies.workers import planner
from planner.errors import FoldingError
from planner.planning.budget import longest_wait_s
from planner.robots.own_robots import robots_folder, use_robots_folder

IN_HAND = 2
"""Cells that a worker has at once."""

TRIES = 2
"""Times that a cell is begun before the death of its worker is its answer."""

DEATHS_MAX = 20
"""Deaths of workers in a row, without an answer between them, after which the study ends."""

_GRACE_S = 30.0
"""A worker is ended so long after its search should have ended by the clock on the wall (s)."""

_RUN_S = 1200.0
"""Further time for each run of a rehearsal (s); one takes 0.5 to 5 minutes of a core (measured)."""

_LOOK_EVERY_S = 1.0
"""Period of the check whether a cell hangs (s)."""

_context = multiprocessing.get_context("forkserver")


@dataclass
class WorkersLostError(FoldingError):
    """Every worker dies, whatever it is given."""

    exit_code: int | None

    def __str__(self) -> str:
        return f"the workers' processes end before they answer anything, with exit code {self.exit_code}"


class _Worker:
    """A process, its pipe, and the cells it has, the one under way first.

    `began_s` is when that one was begun; infinite while the planner is being loaded, which may mean compiled.
    """

    def __init__(self, make_plan: MakePlan | None, keep_plans: bool) -> None:
        self.pipe, theirs = _context.Pipe()
        self.cells: deque[Cell] = deque()
        self.began_s = math.inf
        self._process = _context.Process(
            target=_work, args=(theirs, robots_folder(), make_plan, keep_plans), daemon=True
        )
        self._process.start()
        theirs.close()

    def give(self, cell: Cell) -> bool:
        """Give it a cell; return whether it took it: a worker that has just died does not."""
        if not self.cells and self.began_s < math.inf:
            self.began_s = time.monotonic()
        self.cells.append(cell)
        try:
            self.pipe.send(cell)
        except (BrokenPipeError, ConnectionResetError):
            return False
        return True

    def take(self) -> Answer | None:
        """Return its next answer; None if it has just loaded the planner. Raises `EOFError` if it has died."""
        try:
            answer: Answer | None = self.pipe.recv()
        except ConnectionResetError:
            raise EOFError from None
        self.began_s = time.monotonic()
        if answer is not None:
            self.cells.popleft()
        return answer

    @property
    def hangs(self) -> bool:
        """Whether its cell takes so long that it will not end by itself."""
        cell = self.cells[0] if self.cells else None
        if cell is None or cell.task is None:
            return False
        runs = 0 if cell.rehearsal is None else cell.rehearsal.runs
        longest_s = longest_wait_s(cell.task.limits.time_limit_s) + _GRACE_S + _RUN_S * runs
        return time.monotonic() - self.began_s > longest_s

    def end(self) -> int | None:
        """End it; return its exit code."""
        self._process.kill()
        self._process.join()
        code = self._process.exitcode
        self._process.close()
        self.pipe.close()
        return code


class ProcessPool:
    """Plans the cells in a number of processes."""

    def __init__(self, workers: int, make_plan: MakePlan | None = None) -> None:
        """Start no process before there are cells.

        Args:
            workers: the number of processes.
            make_plan: a module-level function to plan with; by default the planner's.
        """
        self._count = workers
        self._make_plan = make_plan

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        """Yield the answers as they come."""
        yield from _Running(self._count, iter(cells), self._make_plan, keep_plans).answers()


class _Running:
    """A pool at work."""

    def __init__(self, count: int, cells: Iterator[Cell], make_plan: MakePlan | None, keep_plans: bool) -> None:
        self._cells = cells
        self._again: deque[Cell] = deque()
        self._deaths: Counter[int] = Counter()
        self._deaths_in_a_row = 0
        self._make_plan, self._keep_plans = make_plan, keep_plans
        self._workers = [self._new() for _ in range(count)]

    def answers(self) -> Iterator[Answer]:
        try:
            for worker in self._workers:
                self._fill(worker)
            while busy := {worker.pipe: worker for worker in self._workers if worker.cells}:
                ready = multiprocessing.connection.wait(list(busy), _LOOK_EVERY_S)
                for pipe in ready:
                    worker = busy[pipe]  # type: ignore[index]
                    try:
                        answer = worker.take()
                    except EOFError:
                        yield from self._replaced(worker, "")
                        continue
                    if answer is not None:
                        self._deaths_in_a_row = 0
                        self._fill(worker)
                        yield answer
                for worker in [one for one in busy.values() if one.hangs and one.pipe not in ready]:
                    yield from self._replaced(worker, "it did not end long after its time limit")
        finally:
            for worker in self._workers:
                worker.end()

    def _new(self) -> _Worker:
        return _Worker(self._make_plan, self._keep_plans)

    def _fill(self, worker: _Worker) -> None:
        """Give a worker cells until it has enough."""
        while len(worker.cells) < IN_HAND:
            cell = self._again.popleft() if self._again else next(self._cells, None)
            if cell is None or not worker.give(cell):
                return

    def _replaced(self, worker: _Worker, hanging: str) -> Iterator[Answer]:
        """Replace a worker that died or hangs; its cell is begun once more, unless it hangs or has been before."""
        cells = list(worker.cells)
        code = worker.end()
        self._workers[self._workers.index(worker)] = self._new()
        self._deaths_in_a_row += 1
        if self._deaths_in_a_row > DEATHS_MAX:
            raise WorkersLostError(code)
        if cells:
            under_way, *others = cells
            self._again.extend(others)
            self._deaths[under_way.index] += 1
            if hanging or self._deaths[under_way.index] >= TRIES:
                del self._deaths[under_way.index]
                yield failed(under_way, hanging or f"its process ended {TRIES} times, with exit code {code}")
            else:
                self._again.append(under_way)
        for one in self._workers:
            self._fill(one)


def _work(pipe: Connection, robots: Path, make_plan: MakePlan | None, keep_plans: bool) -> None:
    """Plan the cells that come through a pipe; runs in the worker."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program, which ends its workers
    threading.Thread(target=_end_with_parent, daemon=True).start()
    use_robots_folder(robots)
    plan: Any = make_plan or planner()
    pipe.send(None)
    while True:
        try:
            cell: Cell = pipe.recv()
            pipe.send(answered(cell, plan, keep_plan=keep_plans))
        except (EOFError, BrokenPipeError, ConnectionResetError):
            return


def _end_with_parent() -> None:
    """End this process as soon as the program has ended, in the middle of a cell too."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    multiprocessing.connection.wait([parent.sentinel])
    os._exit(1)
