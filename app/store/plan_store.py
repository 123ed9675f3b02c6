"""The plans of this server's life, by id; the oldest go when there are more than a thousand.

The newest are kept as they are, the others in a database of this process alone. It lies in a temporary file without a
name, and a few megabytes of it in memory: what plans take does not grow with their number.
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
LIVE_MAX = 16
"""Plans kept as they are."""

_CACHE_KIB = 4096
_ZIP_LEVEL = 1
"""Plans shrink to a half in a millisecond or two; higher levels take longer and save a twentieth more."""

_log = logging.getLogger(__name__)


@dataclass
class UnknownPlanError(FoldingError):
    """No plan has this id, or it has been dropped."""

    plan_id: str

    def __str__(self) -> str:
        return f"there is no plan with the id {self.plan_id!r}"


class PlanStore:
    """Keeps the newest plans; may be used from any thread."""

    def __init__(self, capacity: int = CAPACITY) -> None:
        """Begin with none."""
        self._capacity = capacity
        self._order: OrderedDict[str, None] = OrderedDict()
        self._live: OrderedDict[str, Plan] = OrderedDict()
        self._stored = _StoredPlans()
        self._lock = threading.Lock()

    def add(self, plan: Plan) -> str:
        """Keep a plan; return its id."""
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
        """Return the plan with this id; raises `UnknownPlanError`."""
        with self._lock:
            if plan_id not in self._order:
                raise UnknownPlanError(plan_id)
            return self._live.get(plan_id) or self._stored.plan(plan_id)

    def drop(self, plan_id: str) -> None:
        """Keep a plan no longer; one that is not there is no fault."""
        with self._lock:
            if plan_id in self._order:
                self._forget(plan_id)

    def _forget(self, plan_id: str) -> None:
        del self._order[plan_id]
        if self._live.pop(plan_id, None) is None:
            self._stored.remove(plan_id)

    def _put_away(self, plan_id: str, plan: Plan) -> None:
        """Move a plan to the database; one that cannot be stored stays as it is."""
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
    """Plans on the disk, as long as this process lives."""

    def __init__(self) -> None:
        self._database = sqlite3.connect("", check_same_thread=False, isolation_level=None)
        self._database.execute(f"PRAGMA cache_size = -{_CACHE_KIB}")
        self._database.execute("CREATE TABLE plans (id TEXT PRIMARY KEY, plan BLOB)")
        weakref.finalize(self, self._database.close)

    def put(self, plan_id: str, packed: bytes) -> None:
        """Store a plan; raises `sqlite3.Error` where there is no room."""
        self._database.execute("INSERT INTO plans VALUES (?, ?)", (plan_id, packed))

    def plan(self, plan_id: str) -> Plan:
        """Return what was stored."""
        found = self._database.execute("SELECT plan FROM plans WHERE id = ?", (plan_id,))
        (packed,) = found.fetchone()
        plan: Plan = pickle.loads(zlib.decompress(packed))
        return plan

    def remove(self, plan_id: str) -> None:
        """Remove a plan."""
        self._database.execute("DELETE FROM plans WHERE id = ?", (plan_id,))
