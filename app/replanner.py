"""Plans a document anew whenever its drawing changes. The latest wins.

Mostly the plan that was shown last still does, with the new measures, or else some plan is found greedily. That
takes much less time than to find the quickest, so it is shown first, and replaced if the search comes to another.

A search for an older drawing is stopped, with one exception. While somebody drags, the next drawing may come before
anything is found, and stopping each for the next would never show a plan. So during a gesture a search is given a
little time to find the first, and that is shown as what it is: a plan for an older version.
"""

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from functools import partial
from typing import TypeAlias

from app.document import Document
from app.document_state import DocumentState, Question
from app.held_folds import held_folds
from app.jobs.job_pool import Job, JobPool, ShouldStop
from app.known_plans import KnownPlans
from app.store.plan_store import PlanStore
from planner import make_plan, quick_plan
from planner.errors import FoldingError, SceneError
from planner.plan.make_plan import TIME_LIMIT_S
from planner.plan.plan import Plan

WORK_S, LONGER_WORK_S = 10.0, 60.0
"""How much work a search may do, and one that was asked to look longer (s of the machine of `planner.plan.budget`).

Not the clock but this ends it, so that what is shown in the end does not depend on how busy the machine was.
"""

PATIENCE_S = 0.5
"""So long after it began a search for a first plan may go on although a preview has made it out of date (s)."""

_REMEMBERED = 8

Show: TypeAlias = Callable[[Plan], None]

_log = logging.getLogger(__name__)


class Replanner:
    """Watches a document."""

    def __init__(self, document: Document, pool: JobPool, plans: PlanStore, arms: int) -> None:
        """Start the first search at once, in the pool."""
        self._document = document
        self._pool = pool
        self._plans = plans
        self._arms = arms
        self._lock = threading.Lock()
        self._version = 0
        self._is_thorough = False
        self._has_failed = False
        self._job: Job[None] | None = None
        self._asked: DocumentState | None = None
        self._is_behind = False
        self._filming: Plan | None = None
        self._known = KnownPlans()
        self._of_previews: set[str] = set()
        self._remembered: OrderedDict[Question, Plan] = OrderedDict()
        self._unsubscribe = document.subscribe(self._look)
        self._look()

    def close(self) -> None:
        """Search no more."""
        self._unsubscribe()
        with self._lock:
            self._stop()

    def _look(self) -> None:
        state = self._document.state
        with self._lock:
            is_again, self._has_failed = self._has_failed and state.failure is None, state.failure is not None
            is_longer, self._is_thorough = state.is_thorough and not self._is_thorough, state.is_thorough
            if is_longer and state.version == self._version:
                self._go_on(state)
                return
            if state.version <= self._version and not is_again:
                return
            self._version = state.version
            if self._asked is not None and state.question is not None and self._asked.question == state.question:
                self._is_behind = False
            elif self._asked is not None and state.draft.gesture is not None:
                self._is_behind = True
            else:
                self._go_on(state)

    def _go_on(self, state: DocumentState) -> None:
        """Do what is left to be done for a version, in place of what is being done."""
        self._stop()
        if not self._is_settled(state):
            self._asked = state
            self._job = self._pool.start(partial(self._work, state, time.monotonic()))

    def _is_settled(self, state: DocumentState) -> bool:
        """Whether nothing is left to be done for a version."""
        if state.failure is not None:
            return True
        if state.checks is None or state.checks.version != state.version:
            return False
        if state.question is None:
            return True
        if state.answer is None or not state.is_answered or not state.answer.is_final:
            return False
        plan, film = state.answer.plan, state.film
        return not plan.is_solved or self._filming is plan or (film is not None and film.plan is plan)

    def _stop(self) -> None:
        if self._job is not None:
            self._job.stop()
        self._asked, self._job, self._is_behind = None, None, False

    def _work(self, state: DocumentState, began_s: float, should_stop: ShouldStop) -> None:
        first: list[Plan] = []

        def is_unwanted() -> bool:
            is_stopped = should_stop()
            now = self._document.state
            shown = now.answer if now.answer is not None and now.answer.version == state.version else None
            is_kept = shown is not None and shown.is_final and any(plan is shown.plan for plan in first)
            is_done = now.failure is not None or is_kept
            if now.version == state.version and is_done:
                return True
            patience_s = PATIENCE_S if shown is None else 0.0
            return is_stopped or (self._is_behind and time.monotonic() - began_s > patience_s)

        plan: Plan | None = None
        try:
            plan = self._planned(state, first, is_unwanted)
        except SceneError as error:
            self._document.fail(state.version, str(error.within("scene")))
        except FoldingError as error:
            self._document.fail(state.version, str(error))
        except Exception:
            _log.exception("version %s could not be planned", state.version)
            self._document.fail(state.version, "the planner failed")
        film_of = self._to_be_filmed(state, plan)
        if film_of is not None:
            self._film(film_of)
            with self._lock:
                self._filming = None

    def _to_be_filmed(self, state: DocumentState, plan: Plan | None) -> Plan | None:
        """The plan that a search ended with, if it is shown now; if something else is wanted by now, that is begun."""
        with self._lock:
            if self._asked is not state:
                return None
            now = self._document.state
            is_shown = now.answer is not None and now.answer.plan is plan and now.is_answered
            self._asked = self._job = None
            self._filming = plan if plan is not None and plan.is_solved and is_shown else None
            self._go_on(now)
            return self._filming

    def _film(self, plan: Plan) -> None:
        """Have a plan played; what is done in it may be on the film already that is shown."""
        shown = self._document.state.film
        try:
            is_known = shown is not None and shown.plan.acts is plan.acts
            self._document.show_film(plan, shown.timeline if shown is not None and is_known else plan.timeline())
        except Exception:
            _log.exception("a plan could not be filmed")

    def _check(self, state: DocumentState) -> None:
        if state.checks is None or state.checks.version != state.version:
            self._document.put_checks(state.drawing, tuple(held_folds(state.solution, self._arms)))

    def _planned(self, state: DocumentState, first: list[Plan], is_unwanted: ShouldStop) -> Plan | None:
        """The answer, once it is published; None when there is nothing to plan, or nobody wants it any more.

        What is shown before that is noted as the first.
        """
        question = state.question
        plan = None if question is None else self._remembered.get(question)
        known = None
        if question is not None and plan is None:
            show = partial(self._show_meanwhile, state.version, question, first, is_unwanted)
            like = self._plans_known()
            known = state.plan_on_show
            if known is not None:
                first.append(known)
            else:
                known = _found_soon(question, like, show, is_unwanted)
        self._check(state)
        if question is None or is_unwanted():
            return None
        if plan is None:
            work_s = LONGER_WORK_S if state.is_thorough else WORK_S
            plan = _quickest(question, work_s, known, like, show, is_unwanted)
            if is_unwanted():
                return None
            if not plan.statistics.is_cut_short:  # else with more work there may be a better one
                self._remember(question, plan)
        self._publish(state.version, question, plan, is_final=True)
        return plan

    def _plans_known(self) -> list[Plan]:
        with self._lock:
            return self._known.by_cost()

    def _show_meanwhile(
        self, version: int, question: Question, first: list[Plan], is_unwanted: ShouldStop, plan: Plan
    ) -> None:
        """Show a plan while a quicker one is looked for."""
        if not is_unwanted():
            first.append(plan)
            self._publish(version, question, plan, is_final=False)
            self._film(plan)

    def _remember(self, question: Question, plan: Plan) -> None:
        with self._lock:
            self._remembered[question] = plan
            while len(self._remembered) > _REMEMBERED:
                self._remembered.popitem(last=False)

    def _publish(self, version: int, question: Question, plan: Plan, *, is_final: bool) -> None:
        """Show the plan; one never shown, or made for a preview and shown no more, need not be readable by its id."""
        before, plan_id = self._document.state.answer, self._plans.add(plan)
        with self._lock:
            self._known.add(plan)
        self._document.settle(version, question, plan, plan_id, is_final=is_final)
        state = self._document.state
        if state.draft.gesture is not None:
            self._of_previews.add(plan_id)
        kept = {answer.plan_id for answer in (state.answer, state.committed, state.before) if answer is not None}
        gone = {plan_id} if before is None or before.plan_id not in self._of_previews else {plan_id, before.plan_id}
        for made in gone - kept:
            self._plans.drop(made)
            self._of_previews.discard(made)


def _found_soon(question: Question, like: list[Plan], show: Show, should_stop: ShouldStop) -> Plan | None:
    """A plan made of those that are known for as many folds, shown at once; None if none was found soon.

    Where there are more folds than before, or fewer, a search tells mostly as soon what is the quickest.
    """
    same = [plan for plan in like if len(plan.garment.folds) == len(question.garment.folds)]
    plan = None
    if same and not should_stop():
        plan = quick_plan(
            question.garment,
            question.scene,
            like=same,
            start_station=question.start_station,
            comfort_radius_m=question.comfort_radius_m,
            should_stop=should_stop,
        )
    if plan is not None:
        show(plan)
    return plan


def _quickest(
    question: Question, work_s: float, known: Plan | None, like: list[Plan], show: Show, should_stop: ShouldStop
) -> Plan:
    return make_plan(
        question.garment,
        question.scene,
        start_station=question.start_station,
        comfort_radius_m=question.comfort_radius_m,
        time_limit_s=TIME_LIMIT_S[1],
        work_limit_s=work_s,
        should_stop=should_stop,
        known=known,
        like=like,
        on_found=show,
    )
