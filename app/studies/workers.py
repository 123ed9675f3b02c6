"""The workers that plan a study's cells, in this process or elsewhere, and how they are given batches of cells."""

from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from itertools import islice
from typing import Protocol

from app.distribution import require
from app.studies.answer import Answer, MakePlan, answered, failed
from app.studies.cell import Cell
from app.studies.fields import StudyError
from app.worker.process import Caller
from app.worker.stop import LimitedStop, StoppedError
from app.worker.workers import Team
from planner.deadline import longest_wait_s
from planner.errors import FoldingError


class Workers(Protocol):
    """Workers that plan the cells of a study."""

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        """Yield the answers to cells as they come, in any order; take cells only as they are needed.

        Closing the iterator ends the work.
        """
        ...


class InProcess:
    """Plans the cells one after the other, in this process."""

    def __init__(self, make_plan: MakePlan | None = None) -> None:
        """Plan with a function; by default the planner's."""
        self._make_plan = make_plan

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        """Yield the answers in the cells' order."""
        make_plan = self._make_plan or planner()
        for cell in cells:
            yield answered(cell, make_plan, keep_plan=keep_plans)


@cache
def planner() -> MakePlan:
    """Return the planner, its kernels loaded; once a process."""
    from planner.planning.warm_up import compile_kernels
    from planner.plans import make_plan

    compile_kernels()
    return make_plan


AHEAD = 2
"""Batches given out for each worker, so that none waits for the next."""

LOST_MAX = 20
"""Losses in a row, without an answer between them, after which the study ends."""


@dataclass
class WorkersLostError(FoldingError):
    """Workers are lost one after the other, with any work."""

    last: str

    def __str__(self) -> str:
        return f"the workers are lost before they answer anything: {self.last}"


def answers_of(
    cells: Iterable[Cell],
    hand_out: Callable[[Sequence[Cell]], Future[list[Answer]]],
    workers: int,
    *,
    batch: int,
    tries: int,
) -> Generator[Answer]:
    """Yield the answers as they come; take cells only as they are needed.

    A batch whose worker is lost comes back cell by cell. A cell that is lost alone is tried again, and at last has that
    as its answer.

    Args:
        cells: the cells.
        hand_out: gives a batch to a worker.
        workers: the number of batches that are done at once.
        batch: the number of cells in a batch.
        tries: how often a cell is handed out alone.

    Raises:
        WorkersLostError: too many batches in a row were lost.
    """
    waiting, alone, lost, lost_in_a_row = iter(cells), list[Cell](), Counter[int](), 0
    under_way: dict[Future[list[Answer]], Sequence[Cell]] = {}
    try:
        while True:
            while len(under_way) < AHEAD * workers and (
                some := [alone.pop()] if alone else list(islice(waiting, batch))
            ):
                under_way[hand_out(some)] = some
            if not under_way:
                return
            for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                some, error = list(under_way.pop(future)), future.exception()
                if error is None:
                    lost_in_a_row = 0
                    yield from future.result()
                    continue
                why = f"{type(error).__name__}: {error}"
                lost_in_a_row += 1
                if lost_in_a_row > LOST_MAX:
                    raise WorkersLostError(why)
                if len(some) == 1:
                    lost[some[0].index] += 1
                if len(some) == 1 and lost[some[0].index] >= tries:
                    del lost[some[0].index]
                    yield failed(some[0], f"its worker was lost: {why}")
                else:
                    alone.extend(some)
    finally:
        for future in under_way:
            future.cancel()


TRIES = 2
"""Times that a cell is begun before the death of its worker is its answer."""

_GRACE_S = 30.0
"""A worker is ended so long after its search should have ended by the clock on the wall (s)."""

_RUN_S = 1200.0
"""Further time for each run of a rehearsal (s); one takes 0.5 to 5 minutes of a core (measured)."""


class LocalWorkers:
    """Plans the cells in a number of processes of this machine."""

    def __init__(self, count: int, make_plan: MakePlan | None = None) -> None:
        """Start no process before there are cells.

        Args:
            count: the number of processes.
            make_plan: a module-level function to plan with; by default the planner's.
        """
        self._count = count
        self._make_plan = make_plan

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        """Yield the answers as they come."""
        with Team(self._count) as team:

            def hand_out(batch: Sequence[Cell]) -> Future[list[Answer]]:
                return team.start(lambda: [self._answer(team, cell, keep_plans) for cell in batch])

            yield from answers_of(cells, hand_out, self._count, batch=1, tries=TRIES)

    def _answer(self, team: Team, cell: Cell, keep_plans: bool) -> Answer:
        with LimitedStop(team.stop, _longest_s(cell)) as limited:
            try:
                return team.run(_work, limited, lambda _: limited.begin(), cell, self._make_plan, keep_plans)
            except StoppedError:
                if team.stop():
                    raise
                return failed(cell, "it did not end long after its time limit")


def _longest_s(cell: Cell) -> float:
    """Return how long a worker may take over a cell (s)."""
    if cell.task is None:
        return _GRACE_S
    runs = 0 if cell.rehearsal is None else cell.rehearsal.runs
    return longest_wait_s(cell.task.limits.time_limit_s) + _GRACE_S + _RUN_S * runs


def _work(caller: Caller, cell: Cell, make_plan: MakePlan | None, keep_plans: bool) -> Answer:
    """Answer a cell, in a worker; tell once the planner is loaded, which may mean compiled."""
    plan = make_plan or planner()
    caller.tell(None)
    return answered(cell, plan, keep_plan=keep_plans)


BATCH = 4
"""Cells in a batch: some tenths of a second of work."""

_CONNECT_S = 10.0
"""Time for the scheduler to answer (s)."""


class ExecutorWorkers:
    """Plans the cells with any executor of `concurrent.futures`, and so on a Dask cluster.

    Cells go out in batches, because a cluster's scheduler takes about a millisecond for each piece of work. It tries a
    lost batch again by itself.
    """

    def __init__(self, executor: Executor, workers: int, make_plan: MakePlan | None = None) -> None:
        """Use an executor, which stays open.

        Args:
            executor: the executor.
            workers: the number of batches that it does at once.
            make_plan: a module-level function to plan with; by default the planner's.
        """
        self._executor = executor
        self._count = workers
        self._make_plan = make_plan

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        """Yield the answers as they come."""
        yield from answers_of(
            cells,
            lambda batch: self._executor.submit(_answers, batch, self._make_plan, keep_plans),
            self._count,
            batch=BATCH,
            tries=1,
        )


@contextmanager
def cluster(address: str) -> Iterator[ExecutorWorkers]:
    """Yield the workers of a Dask cluster.

    Args:
        address: the scheduler's, such as ``tcp://host:8786``.

    Raises:
        StudyError: there is no such scheduler, or it has no workers.
        RequestError: the library is not installed.
    """
    require("distributed")
    from distributed import Client

    try:
        client = Client(address, timeout=_CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise StudyError("", f"no scheduler answers at {address}: {error}") from None
    with client:
        threads = sum(client.nthreads().values())
        if not threads:
            raise StudyError("", f"the scheduler at {address} has no workers")
        with client.get_executor(pure=False) as executor:
            yield ExecutorWorkers(executor, threads)


def _answers(cells: Sequence[Cell], make_plan: MakePlan | None, keep_plans: bool) -> list[Answer]:
    plan = make_plan or planner()
    return [answered(cell, plan, keep_plan=keep_plans) for cell in cells]
