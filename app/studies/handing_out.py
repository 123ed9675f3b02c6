"""Hand cells out to whoever plans them, in batches, and survive that some are lost."""

from collections import Counter
from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from itertools import islice

from app.studies.answer import Answer, failed
from app.studies.cell import Cell
from planner.errors import FoldingError

AHEAD = 2
"""Batches given out for each worker, so that none waits for the next."""

LOST_MAX = 20
"""Losses in a row, without an answer between them, after which the study ends."""


@dataclass
class WorkersLostError(FoldingError):
    """Every worker is lost, whatever it is given."""

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
                told = f"{type(error).__name__}: {error}"
                lost_in_a_row += 1
                if lost_in_a_row > LOST_MAX:
                    raise WorkersLostError(told)
                if len(some) == 1:
                    lost[some[0].index] += 1
                if len(some) == 1 and lost[some[0].index] >= tries:
                    del lost[some[0].index]
                    yield failed(some[0], f"its worker was lost: {told}")
                else:
                    alone.extend(some)
    finally:
        for future in under_way:
            future.cancel()
