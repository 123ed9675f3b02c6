"""The plans of this server's life, by id; the oldest go when there are more than a thousand.

A plan brings along what it was found with, half a megabyte or more. So only the newest are kept as they are; of the
others there are records, in a database of this process alone. It lies in a temporary file without a name, and a few
megabytes of it in memory: what plans take does not grow with their number.
"""

import json
import logging
import sqlite3
import threading
import uuid
import weakref
import zlib
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any, Protocol

from app.store.recorded_plan import RecordedPlan
from planner.errors import FoldingError
from planner.plan.plan import Plan
from planner.plan.timeline import Timeline

CAPACITY = 1000
LIVE_MAX = 16
"""Plans kept as they are."""

_CACHE_KIB = 4096
_ZIP_LEVEL = 1
"""Records shrink to a half in a millisecond or two; higher levels take longer and save a twentieth more."""

_log = logging.getLogger(__name__)


@dataclass
class UnknownPlanError(FoldingError):
    """No plan has this id, or it has been dropped."""

    plan_id: str

    def __str__(self) -> str:
        return f"there is no plan with the id {self.plan_id!r}"


class KeptPlan(Protocol):
    """What is asked of a plan that is kept: `Plan` has it, and `RecordedPlan`."""

    @property
    def status(self) -> str:
        """How the search ended."""

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as JSON."""

    def timeline(self) -> Timeline:
        """Return what robot and cloth do at every moment; raises `UnsolvedPlanError`."""


class PlanStore:
    """Keeps the newest plans; may be used from any thread."""

    def __init__(self, capacity: int = CAPACITY) -> None:
        """Empty at first."""
        self._capacity = capacity
        self._order: OrderedDict[str, None] = OrderedDict()
        self._live: OrderedDict[str, Plan | RecordedPlan] = OrderedDict()
        self._records = _Records()
        self._lock = threading.Lock()

    def add(self, plan: Plan | RecordedPlan) -> str:
        """Keep a plan; returns its id."""
        plan_id = uuid.uuid4().hex
        with self._lock:
            self._live[plan_id] = plan
            self._order[plan_id] = None
            while len(self._order) > self._capacity:
                self._forget(next(iter(self._order)))
            oldest = next(iter(self._live.items())) if len(self._live) > LIVE_MAX else None
        if oldest is not None:
            self._put_away(*oldest)
        return plan_id

    def plan(self, plan_id: str) -> KeptPlan:
        """Return the plan with this id; raises `UnknownPlanError`."""
        with self._lock:
            if plan_id not in self._order:
                raise UnknownPlanError(plan_id)
            return self._live.get(plan_id) or self._records.record(plan_id)

    def drop(self, plan_id: str) -> None:
        """Keep a plan no longer; one that is not there is no fault."""
        with self._lock:
            if plan_id in self._order:
                self._forget(plan_id)

    def _forget(self, plan_id: str) -> None:
        del self._order[plan_id]
        if self._live.pop(plan_id, None) is None:
            self._records.remove(plan_id)

    def _put_away(self, plan_id: str, plan: Plan | RecordedPlan) -> None:
        """Keep a record of a plan instead; one of which none can be made, or stored, stays as it is."""
        try:
            record = plan if isinstance(plan, RecordedPlan) else RecordedPlan.of(plan)
            with self._lock:
                if plan_id in self._live:
                    self._records.put(plan_id, record)
                    del self._live[plan_id]
        except Exception:
            _log.exception("a plan could not be put away")
            with self._lock:
                if plan_id in self._live:
                    self._live.move_to_end(plan_id)


class _Records:
    """Plans as they were told and are played, on the disk as long as this process lives."""

    def __init__(self) -> None:
        self._database = sqlite3.connect("", check_same_thread=False, isolation_level=None)
        self._database.execute(f"PRAGMA cache_size = -{_CACHE_KIB}")
        self._database.execute("CREATE TABLE plans (id TEXT PRIMARY KEY, status TEXT, body BLOB, played BLOB)")
        weakref.finalize(self, self._database.close)

    def put(self, plan_id: str, plan: RecordedPlan) -> None:
        """Store a record; raises `sqlite3.Error` where there is no room."""
        body = zlib.compress(json.dumps(plan.body).encode(), _ZIP_LEVEL)
        row = (plan_id, plan.status, body, zlib.compress(plan.played, _ZIP_LEVEL))
        self._database.execute("INSERT INTO plans VALUES (?, ?, ?, ?)", row)

    def record(self, plan_id: str) -> RecordedPlan:
        """Return what was stored."""
        found = self._database.execute("SELECT status, body, played FROM plans WHERE id = ?", (plan_id,))
        status, body, played = found.fetchone()
        return RecordedPlan(status, json.loads(zlib.decompress(body)), zlib.decompress(played))

    def remove(self, plan_id: str) -> None:
        """Remove a record."""
        self._database.execute("DELETE FROM plans WHERE id = ?", (plan_id,))
