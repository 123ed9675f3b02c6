"""Plans a document again whenever its drawing changes. The latest version wins.

A new version stops the search for an older one, with one exception. During a gesture, new versions may arrive faster
than any search finds a plan, so that no plan would ever appear. So a search then gets a little time to find its first
plan, which is shown as a plan for an older version.
"""

import logging
import threading
import time
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

from app.document import Document
from app.document_state import DocumentState
from app.held_folds import held_folds
from app.jobs.job_pool import Job, JobPool, ShouldStop
from app.live_search import LiveSearch
from app.store.plan_store import PlanStore
from planner.errors import FoldingError, SceneError
from planner.planning.warm_up import compile_kernels, must_compile
from planner.robots.load_robot import prepare_robot, robot_card_file
from planner.task.plan import Plan

WORK_S, LONGER_WORK_S = 10.0, 60.0
"""Limits on the work of a search, and of one extended by the user (s on the machine of `planner.planning.budget`).

Work and not time limits a search, so that its result does not depend on how busy the machine is.
"""

PATIENCE_S = 0.5
"""Time after its start for which a search for a first plan may outlive its version during a gesture (s)."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Resting:
    """There is nothing left to plan."""


@dataclass(frozen=True, slots=True, eq=False)
class Searching:
    """A search for a plan is in progress.

    Attributes:
        asked: the document's state at its start.
        job: the work.
        is_behind: whether a gesture has gone on since, so that the search has little time left.
    """

    asked: DocumentState
    job: Job[None]
    is_behind: bool = False


Phase: TypeAlias = Resting | Searching


class Replanner:
    """Plans one document as it changes."""

    def __init__(self, document: Document, pool: JobPool, plans: PlanStore) -> None:
        """Start the first search at once, in the pool."""
        self._document = document
        self._pool = pool
        self._plans = plans
        self._search = LiveSearch()
        self._of_previews: set[str] = set()
        self._lock = threading.RLock()
        self._phase: Phase = Resting()
        self._seen: DocumentState | None = None
        self._unsubscribe = document.subscribe(self._look)
        self._look()

    def close(self) -> None:
        """Stop searching."""
        self._unsubscribe()
        with self._lock:
            self._rest()

    def _look(self) -> None:
        """React to a change of the document."""
        state = self._document.state
        with self._lock:
            seen, self._seen = self._seen, state
            is_asked_again = seen is not None and seen.failure is not None and state.failure is None
            is_asked_longer = seen is not None and state.is_thorough and not seen.is_thorough
            is_redrawn = seen is None or state.version > seen.version
            is_restarted = seen is not None and state.start != seen.start
            if (is_asked_longer or is_restarted) and not is_redrawn:
                self._begin(state)
            elif is_redrawn or is_asked_again:
                self._follow(state)

    def _follow(self, state: DocumentState) -> None:
        """Continue with another version, or with one that needs its answer again."""
        match self._phase:
            case Searching(asked, job) if state.task is not None and asked.task == state.task:
                self._phase = Searching(asked, job, is_behind=False)
            case Searching(asked, job) if state.draft.gesture is not None:
                self._phase = Searching(asked, job, is_behind=True)
            case _:
                self._begin(state)

    def _begin(self, state: DocumentState) -> None:
        """Start the remaining work for a version, in place of the current work."""
        self._rest()
        if not _is_settled(state):
            self._phase = Searching(state, self._pool.start(partial(self._work, state, time.monotonic())))

    def _rest(self) -> None:
        if isinstance(self._phase, Searching):
            self._phase.job.stop()
        self._phase = Resting()

    def _has_ended(self, state: DocumentState) -> None:
        """Start the next work after a search has ended."""
        with self._lock:
            if isinstance(self._phase, Searching) and self._phase.asked is state:
                self._begin(self._document.state)

    def _is_behind(self, state: DocumentState) -> bool:
        phase = self._phase
        return isinstance(phase, Searching) and phase.asked is state and phase.is_behind

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
            return is_stopped or (self._is_behind(state) and time.monotonic() - began_s > patience_s)

        try:
            self._plan(state, first, is_unwanted)
        except SceneError as error:
            self._document.fail(state.version, str(error.within("scene")))
        except FoldingError as error:
            self._document.fail(state.version, str(error))
        except Exception:
            _log.exception("version %s could not be planned", state.version)
            self._document.fail(state.version, "the planner failed")
        self._has_ended(state)

    def _plan(self, state: DocumentState, first: list[Plan], is_unwanted: ShouldStop) -> None:
        """Show plans for a version, each better than the previous one; append those that are not final to `first`."""

        def show(plan: Plan, *, is_final: bool) -> None:
            if not is_final:
                first.append(plan)
            self._publish(state, plan, is_final=is_final)

        task, begun = state.task, None
        if task is not None:
            self._prepare(task.robot)
            shown = state.plan_on_show
            first += [] if shown is None else [shown]
            begun = self._search.find_soon(task, shown, show, is_unwanted)
        self._check(state)
        if begun is not None and not is_unwanted():
            work_s = LONGER_WORK_S if state.is_thorough else self._document.state.work_s or WORK_S
            self._search.find_quickest(begun, work_s, show, is_unwanted)

    def _prepare(self, robot: str) -> None:
        """Compile the kernels and map the robot's arms if nobody has yet, and tell that, and how far it is."""
        if must_compile(robot):
            self._document.compile(is_compiling=True)
            try:
                compile_kernels(robot)
            finally:
                self._document.compile(is_compiling=False)
        try:
            prepare_robot(robot, self._document.prepare)
        finally:
            self._document.prepare(None)

    def _check(self, state: DocumentState) -> None:
        if state.checks is None or state.checks.version != state.version:
            arms = len(robot_card_file(state.drawing.robot).arms)
            self._document.put_checks(state.drawing, tuple(held_folds(state.solution, arms)))

    def _publish(self, asked: DocumentState, plan: Plan, *, is_final: bool) -> None:
        """Show a plan; then write it if it is final and no preview's, and drop the plans that nobody needs by id.

        These are plans that were never shown, and those of previews that another preview's replaces. Others can be read
        for a while once they are replaced: a page may have been told of them a moment ago.
        """
        assert asked.task is not None, "what has no task is not planned"
        now = self._document.state
        before, is_preview = now.answer, now.draft.gesture is not None
        plan_id = self._plans.add(plan, is_passing=True)
        self._document.settle(asked.version, asked.task, plan, plan_id, is_final=is_final)
        state = self._document.state
        kept = {answer.plan_id for answer in (state.answer, state.committed, state.before) if answer is not None}
        if is_preview:
            self._of_previews.add(plan_id)
        elif is_final and plan_id in kept:
            self._plans.keep(plan_id)
        left = {plan_id} if before is None else {plan_id, before.plan_id}
        for made in left - kept:
            if made == plan_id or (is_preview and made in self._of_previews):
                self._plans.drop(made)
            else:
                self._plans.let_go(made)
            self._of_previews.discard(made)


def _is_settled(state: DocumentState) -> bool:
    """Return whether a version needs no more work."""
    if state.failure is not None:
        return True
    if state.checks is None or state.checks.version != state.version:
        return False
    return state.task is None or (state.answer is not None and state.is_answered and state.answer.is_final)
