"""Plans a document again whenever its drawing changes. The latest version wins.

A new version stops the search for an older one, with one exception. During a gesture, new versions may arrive faster
than any search finds a plan, so that no plan would ever appear. So a search then gets a little time to find its first
plan, which is shown as a plan for an older version.

Searches run in workers; here is only decided which of them is still wanted, at each change of the document.
"""

import logging
import threading
import time
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TypeAlias

from app.document import Document
from app.document_state import DocumentState
from app.held_folds import held_folds
from app.jobs.job_pool import JobPool
from app.live_search import LiveSearch
from app.store.plan_store import PlanStore
from app.worker.stop import Stop, StoppedError
from app.worker.workers import Workers
from planner.errors import FoldingError, SceneError
from planner.planning.warm_up import must_compile
from planner.robots.load_robot import robot_card_file
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
        is_behind: whether a gesture has gone on since, so that the search has little time left.
        began_s: when it was asked for, by the monotonic clock (s).
        stop: stops it.
        first: the plans of the version that are not final: the one on show at the start, and those found since.
    """

    asked: DocumentState
    is_behind: bool = False
    began_s: float = field(default_factory=time.monotonic)
    stop: Stop = field(default_factory=Stop)
    first: list[Plan] = field(default_factory=list)


Phase: TypeAlias = Resting | Searching


class Replanner:
    """Plans one document as it changes."""

    def __init__(self, document: Document, pool: JobPool, workers: Workers, plans: PlanStore) -> None:
        """Start the first search at once, in the workers; a thread of the pool waits for it."""
        self._document = document
        self._pool = pool
        self._plans = plans
        self._search = LiveSearch(workers, plans.answers)
        self._of_previews: set[str] = set()
        self._lock = threading.RLock()
        self._phase: Phase = Resting()
        self._seen: DocumentState | None = None
        self._closed = Stop()
        self._unsubscribe = document.subscribe(self._look)
        self._look()

    def close(self) -> None:
        """Stop searching."""
        self._unsubscribe()
        with self._lock:
            self._rest()
        self._closed.set()
        self._search.close()

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
            if isinstance(self._phase, Searching) and _is_needless(self._phase, state):
                self._phase.stop.set()

    def _follow(self, state: DocumentState) -> None:
        """Continue with another version, or with one that needs its answer again."""
        match self._phase:
            case Searching(asked) if state.task is not None and asked.task == state.task:
                self._phase = replace(self._phase, is_behind=False)
            case Searching(_, is_behind) if state.draft.gesture is not None:
                self._phase = replace(self._phase, is_behind=True)
                if not is_behind:
                    self._be_patient(self._phase)
            case _:
                self._begin(state)

    def _be_patient(self, search: Searching) -> None:
        """Stop a search that is behind once its time is over."""
        left_s = max(0.0, search.began_s + PATIENCE_S - time.monotonic())
        timer = threading.Timer(left_s, self._end_patience, (search.stop,))
        timer.daemon = True
        timer.start()

    def _end_patience(self, stop: Stop) -> None:
        with self._lock:
            if isinstance(self._phase, Searching) and self._phase.stop is stop and self._phase.is_behind:
                stop.set()

    def _begin(self, state: DocumentState) -> None:
        """Start the remaining work for a version, in place of the current work."""
        self._rest()
        if not _is_settled(state):
            shown = state.plan_on_show
            search = Searching(state, first=[] if shown is None else [shown])
            self._phase = search
            self._pool.start(partial(self._work, search))

    def _rest(self) -> None:
        if isinstance(self._phase, Searching):
            self._phase.stop.set()
        self._phase = Resting()

    def _has_ended(self, search: Searching) -> None:
        """Start the next work after a search has ended."""
        with self._lock:
            if isinstance(self._phase, Searching) and self._phase.stop is search.stop:
                self._begin(self._document.state)

    def _work(self, search: Searching, stop: Stop) -> None:
        """Do a search, unless it or the pool's job is stopped."""
        version, forget = search.asked.version, stop.then(search.stop.set)
        try:
            self._plan(search, stop)
        except StoppedError:
            pass
        except SceneError as error:
            self._document.fail(version, str(error.within("scene")))
        except FoldingError as error:
            self._document.fail(version, str(error))
        except Exception:
            _log.exception("version %s could not be planned", version)
            self._document.fail(version, "the planner failed")
        finally:
            forget()
        self._has_ended(search)

    def _plan(self, search: Searching, stop: Stop) -> None:
        """Show plans for a version, each better than the previous one."""
        state = search.asked
        if state.task is None:
            self._check(state)
            return

        def show(plan: Plan, *, is_final: bool) -> None:
            if not is_final:
                search.first.append(plan)
            self._publish(state, plan, is_final=is_final)

        self._prepare(state.task.robot, stop)
        work_s = LONGER_WORK_S if state.is_thorough else self._document.state.work_s or WORK_S
        self._search.find(state.task, state.plan_on_show, work_s, show, partial(self._check, state), search.stop)

    def _prepare(self, robot: str, stop: Stop) -> None:
        """Have the planner compiled and the robot's arms mapped, and tell that, and how far it is.

        A new version does not stop this: it needs the same.
        """
        either = Stop()
        forget = [one.then(either.set) for one in (stop, self._closed)]
        is_compiling = must_compile(robot)
        if is_compiling:
            self._document.compile(is_compiling=True)
        try:
            self._search.prepare(robot, self._has_compiled, self._document.prepare, either)
        finally:
            for one in forget:
                one()
            self._has_compiled()
            self._document.prepare(None)

    def _has_compiled(self) -> None:
        if self._document.state.is_compiling:
            self._document.compile(is_compiling=False)

    def _check(self, state: DocumentState) -> None:
        if state.checks is None or state.checks.version != state.version:
            arms = len(robot_card_file(state.drawing.robot).arms)
            self._document.put_checks(state.drawing, tuple(held_folds(state.solution, arms)))

    def _publish(self, asked: DocumentState, plan: Plan, *, is_final: bool) -> None:
        """Show a plan; then write it if it is final and no preview's, and drop the plans that nobody needs by id.

        These are plans that were never shown, and those of previews that another preview's replaces. Others can be read
        for a while once they are replaced: a page may have been sent them a moment ago.
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


def _is_needless(search: Searching, now: DocumentState) -> bool:
    """Return whether a search may be dropped: it has failed, or its result is kept elsewhere."""
    version, answer = search.asked.version, now.answer
    shown = answer if answer is not None and answer.version == version else None
    if search.is_behind and shown is not None:
        return True
    is_kept = shown is not None and shown.is_final and any(plan is shown.plan for plan in search.first)
    return now.version == version and (now.failure is not None or is_kept)


def _is_settled(state: DocumentState) -> bool:
    """Return whether a version needs no more work."""
    if state.failure is not None:
        return True
    if state.checks is None or state.checks.version != state.version:
        return False
    return state.task is None or (state.answer is not None and state.is_answered and state.answer.is_final)
