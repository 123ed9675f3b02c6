"""The workers of this machine (`app.worker`), for studies."""

from collections.abc import Generator, Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

from app.studies.answer import Answer, MakePlan, answered, failed
from app.studies.cell import Cell
from app.studies.workers import answers_of, planner
from app.worker.process import Caller
from app.worker.stop import LimitedStop, Stop, StoppedError
from app.worker.workers import Workers
from planner.deadline import longest_wait_s

TRIES = 2
"""Times that a cell is begun before the death of its worker is its answer."""

_GRACE_S = 30.0
"""A worker is ended so long after its search should have ended by the clock on the wall (s)."""

_RUN_S = 1200.0
"""Further time for each run of a rehearsal (s); one takes 0.5 to 5 minutes of a core (measured)."""


class LocalWorkers:
    """Plans the cells in a number of processes."""

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
        stop = Stop()
        with Workers(kept=self._count) as workers, ThreadPoolExecutor(self._count) as threads:

            def hand_out(batch: Sequence[Cell]) -> Future[list[Answer]]:
                return threads.submit(lambda: [self._answer(workers, stop, cell, keep_plans) for cell in batch])

            try:
                yield from answers_of(cells, hand_out, self._count, batch=1, tries=TRIES)
            finally:
                stop.set()

    def _answer(self, workers: Workers, stop: Stop, cell: Cell, keep_plans: bool) -> Answer:
        with LimitedStop(stop, _longest_s(cell)) as limited:
            try:
                return workers.run(_work, limited, lambda _: limited.begin(), cell, self._make_plan, keep_plans)
            except StoppedError:
                if stop():
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
