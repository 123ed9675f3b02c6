"""Keeps the plans made since the server started, by id; drops the oldest beyond a thousand.

The newest stay in memory as objects, the others in a database private to this process. The database is an unnamed
temporary file with a few megabytes of cache, so memory does not grow with the number of plans.
"""

import logging
import pickle
import sqlite3
import threading
import uuid
import weakref
import zlib
from collections import OrderedDict
from dataclasses import dataclass

from planner.errors import FoldingError
from planner.task.plan import Plan

CAPACITY = 1000
"""Number of plans kept."""

LIVE_MAX = 16
"""Number of plans kept as objects."""

_CACHE_KIB = 4096
"""Size of the database's cache in memory (KiB)."""

_ZIP_LEVEL = 1
"""Compression level. Level 1 halves a plan in 1-2 ms; higher levels take longer and save only 5 % more (measured)."""

_log = logging.getLogger(__name__)


@dataclass
class UnknownPlanError(FoldingError):
    """No plan has this id, or it has been dropped."""

    plan_id: str

    def __str__(self) -> str:
        return f"there is no plan with the id {self.plan_id!r}"


class PlanStore:
    """Keeps the newest plans; safe to use from any thread."""

    def __init__(self, capacity: int = CAPACITY) -> None:
        """Start empty."""
        self._capacity = capacity
        self._order: OrderedDict[str, None] = OrderedDict()
        self._live: OrderedDict[str, Plan] = OrderedDict()
        self._stored = _StoredPlans()
        self._lock = threading.Lock()

    def add(self, plan: Plan) -> str:
        """Store a plan; return its id."""
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

    def plan(self, plan_id: str) -> Plan:
        """Return the plan with this id; raise `UnknownPlanError` if there is none."""
        with self._lock:
            if plan_id not in self._order:
                raise UnknownPlanError(plan_id)
            return self._live.get(plan_id) or self._stored.plan(plan_id)

    def drop(self, plan_id: str) -> None:
        """Drop a plan, if it is there."""
        with self._lock:
            if plan_id in self._order:
                self._forget(plan_id)

    def _forget(self, plan_id: str) -> None:
        del self._order[plan_id]
        if self._live.pop(plan_id, None) is None:
            self._stored.remove(plan_id)

    def _put_away(self, plan_id: str, plan: Plan) -> None:
        """Move a plan to the database; keep it as an object if that fails."""
        try:
            packed = _packed(plan)
            with self._lock:
                if plan_id in self._live:
                    self._stored.put(plan_id, packed)
                    del self._live[plan_id]
        except Exception:
            _log.exception("a plan could not be put away")
            with self._lock:
                if plan_id in self._live:
                    self._live.move_to_end(plan_id)


def _packed(plan: Plan) -> bytes:
    return zlib.compress(pickle.dumps(plan, pickle.HIGHEST_PROTOCOL), _ZIP_LEVEL)


class _StoredPlans:
    """Plans on the disk, for the lifetime of this process."""

    def __init__(self) -> None:
        self._database = sqlite3.connect("", check_same_thread=False, isolation_level=None)
        self._database.execute(f"PRAGMA cache_size = -{_CACHE_KIB}")
        self._database.execute("CREATE TABLE plans (id TEXT PRIMARY KEY, plan BLOB)")
        weakref.finalize(self, self._database.close)

    def put(self, plan_id: str, packed: bytes) -> None:
        """Store a plan; raise `sqlite3.Error` if there is no room."""
        self._database.execute("INSERT INTO plans VALUES (?, ?)", (plan_id, packed))

    def plan(self, plan_id: str) -> Plan:
        """Return a stored plan."""
        found = self._database.execute("SELECT plan FROM plans WHERE id = ?", (plan_id,))
        (packed,) = found.fetchone()
        plan: Plan = pickle.loads(zlib.decompress(packed))
        return plan

    def remove(self, plan_id: str) -> None:
        """Remove a plan."""
        self._database.execute("DELETE FROM plans WHERE id = ?", (plan_id,))
