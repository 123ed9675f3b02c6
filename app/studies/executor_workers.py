"""Any executor of `concurrent.futures` as workers, and so a Dask cluster.

Cells go out in batches, because a cluster's scheduler takes about a millisecond for each piece of work. It tries a lost
batch again by itself.
"""

from collections.abc import Generator, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager

from app.distribution import require
from app.studies.answer import Answer, MakePlan, answered
from app.studies.cell import Cell
from app.studies.fields import StudyError
from app.studies.workers import answers_of, planner

BATCH = 4
"""Cells in a batch: some tenths of a second of work."""

_CONNECT_S = 10.0
"""Time for the scheduler to answer (s)."""


class ExecutorWorkers:
    """Plans the cells with an executor."""

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
