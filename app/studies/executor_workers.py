"""Any executor of `concurrent.futures` as workers, and so a Dask cluster.

Cells go out in batches, because a cluster's scheduler takes about a millisecond for each piece of work. A batch whose
worker is lost comes back cell by cell, once; a cell that is lost alone has that as its answer.
"""

from collections.abc import Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager
from functools import partial
from itertools import islice

from app.studies.answer import Answer, MakePlan, answered, failed
from app.studies.cell import Cell
from app.studies.study_error import StudyError
from app.studies.workers import planner

BATCH = 4
"""Cells in a batch: some tenths of a second of work."""

_AHEAD = 2
"""Batches given out for each worker, so that none waits for the next."""

_CONNECT_S = 10.0
"""Time for the scheduler to answer (s)."""


class ExecutorWorkers:
    """Plans the cells with an executor."""

    def __init__(self, executor: Executor, workers: int, make_plan: MakePlan | None = None, batch: int = BATCH) -> None:
        """Use an executor, which stays open.

        Args:
            executor: the executor.
            workers: the number of batches that it does at once.
            make_plan: a module-level function to plan with; by default the planner's.
            batch: the number of cells in a batch.
        """
        self._executor = executor
        self._in_flight = _AHEAD * workers
        self._make_plan = make_plan
        self._batch = batch

    def answers(self, cells: Iterable[Cell], *, keep_plans: bool = False) -> Generator[Answer]:
        """Yield the answers as they come."""
        waiting, alone = iter(cells), list[Cell]()
        work = partial(_answers, make_plan=self._make_plan, keep_plans=keep_plans)
        under_way: dict[Future[list[Answer]], Sequence[Cell]] = {}
        try:
            while True:
                while len(under_way) < self._in_flight and (
                    batch := [alone.pop()] if alone else list(islice(waiting, self._batch))
                ):
                    under_way[self._executor.submit(work, batch)] = batch
                if not under_way:
                    return
                for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                    batch, error = list(under_way.pop(future)), future.exception()
                    if error is None:
                        yield from future.result()
                    elif len(batch) == 1:
                        yield failed(batch[0], f"its worker was lost: {type(error).__name__}: {error}")
                    else:
                        alone.extend(batch)
        finally:
            for future in under_way:
                future.cancel()


@contextmanager
def cluster(address: str) -> Iterator[ExecutorWorkers]:
    """Yield the workers of a Dask cluster.

    Args:
        address: the scheduler's, such as ``tcp://host:8786``.

    Raises:
        StudyError: there is no such scheduler, it has no workers, or the library is not installed.
    """
    try:
        from distributed import Client
    except ImportError:
        raise StudyError("", "a cluster needs the library distributed: pip install pleat[cluster]") from None
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
