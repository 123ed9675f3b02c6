"""The protocol of workers that plan a study's cells: in this process, in processes of this machine, or on a cluster."""

from collections.abc import Generator, Iterable
from functools import cache
from typing import Protocol

from app.studies.answer import Answer, MakePlan, answered
from app.studies.cell import Cell


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
