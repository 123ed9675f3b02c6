"""Has a document planned in a worker while it is being drawn, unless the answer is remembered."""

import math
import uuid
from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

from app.live_planning import Compiled, Found, Lasting, Mapped, plan_live, prepare_live
from app.store.packed_plan import Answers
from app.worker.stop import Stop
from app.worker.workers import Workers
from planner.task.plan import Plan
from planner.task.task import Task


class Show(Protocol):
    """Shows a plan."""

    def __call__(self, plan: Plan, *, is_final: bool) -> None:
        """Show a plan; a quicker one may follow unless it is final."""


class LiveSearch:
    """Plans one document's drawings, one after the other, in the worker that knows the plans before."""

    def __init__(self, workers: Workers, answers: Answers) -> None:
        """Start without known plans; `answers` are those of all documents."""
        self._workers = workers
        self._key = uuid.uuid4().hex
        self._shown: Found | None = None
        self._answers = answers

    def close(self) -> None:
        """Leave the worker to others."""
        self._workers.forget(self._key)

    def prepare(
        self, robot: str, on_compiled: Callable[[], None], on_share: Callable[[float], None], stop: Stop
    ) -> None:
        """Compile the planner and map the robot's arms if nobody has yet; tell when it is compiled, and how far it is.

        What has been done when this is stopped has to be done again. Raises as `Workers.run` does.
        """

        def hear(news: Compiled | Mapped) -> None:
            if isinstance(news, Mapped):
                on_share(news.share)
            else:
                on_compiled()

        self._workers.run_for(self._key, prepare_live, stop, hear, robot)

    def find(
        self,
        task: Task,
        shown: Plan | None,
        work_limit_s: float,
        show: Show,
        on_lasting: Callable[[], None],
        stop: Stop,
    ) -> None:
        """Show a plan derived from known ones if that is quick, and then the quickest.

        Args:
            task: the task.
            shown: the plan on show for it, if any.
            work_limit_s: the limit on the work (s, see `Limits`).
            show: shows a plan; not called once the search is stopped.
            on_lasting: called once what is found soon has been shown.
            stop: stops the search.

        Raises:
            StoppedError: the search was stopped.
            LostProcessError: the worker has ended.
            Exception: whatever the planner raises.
        """
        remembered = self._answers.get(task)
        if remembered is not None:
            on_lasting()
            if not stop():
                show(remembered.plan(), is_final=True)
            return

        packed = self._answers.proposed(task)
        proposed = None if packed is None else packed.plan()
        if proposed is not None and not stop():
            show(proposed, is_final=False)

        def hear(news: Found | Lasting) -> None:
            if isinstance(news, Lasting):
                on_lasting()
                return
            self._shown = news
            if news.packed is not None:
                self._answers.add(task, news.packed)
            if proposed is None or _is_better(news, proposed):
                show(news.plan, is_final=news.is_final)
            elif news.is_final:
                statistics = replace(news.plan.statistics, bound_s=None)  # it may be one for hands that hold firmly
                kept = replace(proposed, task=news.plan.task, statistics=statistics, is_exhaustive=False)
                show(kept, is_final=True)

        known = self._shown.name if self._shown is not None and self._shown.plan is shown else None
        self._workers.run_for(self._key, plan_live, stop, hear, self._key, task, known, work_limit_s)


def _is_better(news: Found, proposed: Plan) -> bool:
    """Return whether a plan that was found takes the place of the one with which its task was proposed.

    A search's answer does if it has a plan, even a dearer one: it may hold firmly where the other does not, and equal
    tasks have equal answers.
    """
    if news.is_final:
        return news.plan.is_solved
    return (news.plan.cost_s or math.inf) < (proposed.cost_s or math.inf)
