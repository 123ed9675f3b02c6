"""The workers that plan a study's cells, in this process or elsewhere, and how they are given batches of cells."""

from collections import Counter
from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from functools import cache
from itertools import islice
from typing import Protocol

from app.studies.answer import Answer, MakePlan, answered, failed
from app.studies.cell import Cell
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
