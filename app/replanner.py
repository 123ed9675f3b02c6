"""Plans a document anew whenever something in it asks for it. The latest wins."""

import threading
from functools import partial

from app.document import Document, DocumentState
from app.job_pool import Job, JobPool, ShouldStop
from app.plan_store import PlanStore
from planner import make_plan
from planner.errors import FoldingError


class Replanner:
    """Watches a document; a search for an older version of it is stopped."""

    def __init__(self, document: Document, pool: JobPool, plans: PlanStore) -> None:
        """Start the first search at once, in the pool."""
        self._document = document
        self._pool = pool
        self._plans = plans
        self._version = 0
        self._job: Job[None] | None = None
        self._lock = threading.Lock()
        self._unsubscribe = document.subscribe(self._look)
        self._look()

    def close(self) -> None:
        """Search no more."""
        self._unsubscribe()
        with self._lock:
            if self._job is not None:
                self._job.stop()

    def _look(self) -> None:
        state = self._document.state
        with self._lock:
            if state.version <= self._version:
                return
            self._version = state.version
            if self._job is not None:
                self._job.stop()
            self._job = self._pool.start(partial(self._plan, state))

    def _plan(self, state: DocumentState, should_stop: ShouldStop) -> None:
        try:
            plan = make_plan(state.garment, state.scene, should_stop=should_stop)
            timeline = plan.timeline() if plan.primitives else None
        except FoldingError as error:
            self._document.fail(state.version, str(error))
            return
        except Exception:
            self._document.fail(state.version, "The planner failed.")
            raise
        if not should_stop():
            self._document.settle(state.version, plan, self._plans.add(plan), timeline)
