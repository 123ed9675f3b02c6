"""Keeps the newest plans in the database, by id, so that they can be read after a restart too.

The plans made last also stay in memory, packed (`app.store.packed_plan`), and those read last as objects: these take
0.7 MB, six times as much, and hardly anybody asks for the plan of a drawing that has been changed since.
"""

import logging
import threading
import uuid
from collections import OrderedDict
from dataclasses import dataclass

from sqlalchemy import delete, insert, select

from app.store.database import Database
from app.store.packed_plan import Answers, PackedPlan, unpacked
from app.store.schema import PlanRow, drop_oldest
from planner.errors import FoldingError
from planner.task.plan import Plan

CAPACITY, CAPACITY_BYTES = 1000, 128 << 20
"""Number of plans kept, and their size (bytes)."""

LIVE_MAX = 16
"""Number of plans in memory beside the database's, packed unless they have been read."""

PASSING_MAX = 24
"""Number of plans in passing kept: each document has one or two while its drawing is under a hand. What is beyond is
written if it may still be asked for.
"""

_DROP_EVERY = 16
"""Plans added between two looks at whether the oldest are to be dropped."""

_log = logging.getLogger(__name__)


@dataclass
class UnknownPlanError(FoldingError):
    """No plan has this id, or it has been dropped."""

    plan_id: str

    def __str__(self) -> str:
        return f"there is no plan with the id {self.plan_id[:80]!r}"


class PlanStore:
    """Keeps the newest plans; safe to use from any thread.

    Attributes:
        answers: the answers to the tasks asked last, for whoever asks one of them again.
    """

    def __init__(self, database: Database, capacity: int = CAPACITY, capacity_bytes: int = CAPACITY_BYTES) -> None:
        """Use a database; read nothing yet."""
        self.answers = Answers()
        self._database = database
        self._capacity, self._capacity_bytes = capacity, capacity_bytes
        self._live_max = min(LIVE_MAX, capacity)
        self._live: OrderedDict[str, Plan | PackedPlan] = OrderedDict()
        self._passing: OrderedDict[str, Plan] = OrderedDict()
        self._let_go: set[str] = set()
        self._added = 0
        self._lock = threading.Lock()

    def add(self, plan: Plan, *, is_passing: bool = False) -> str:
        """Store a plan and return its id.

        Where the database refuses, the plan can be read while it is among the newest.

        Args:
            plan: the plan.
            is_passing: whether it may be dropped soon, as that of a drawing under a hand; it is not written then.
        """
        plan_id = uuid.uuid4().hex
        if not is_passing:
            self._write_and_hold(plan_id, plan)
            return plan_id
        with self._lock:
            self._passing[plan_id] = plan
            oldest = self._passing.popitem(last=False) if len(self._passing) > PASSING_MAX else None
            is_needed = oldest is not None and oldest[0] not in self._let_go
            self._let_go &= self._passing.keys()
        if oldest is not None and is_needed:  # it has stayed after all
            self._write(*oldest)
        return plan_id

    def add_packed(self, packed: PackedPlan, named: str | None = None) -> str:
        """Store a plan that was packed, and perhaps named, elsewhere; return its id; unpack it only when asked for."""
        plan_id = named or uuid.uuid4().hex
        self._write_content(plan_id, packed.content)
        self._hold(plan_id, packed)
        return plan_id

    def keep(self, plan_id: str) -> None:
        """Write a passing plan to the database, so that it stays."""
        with self._lock:
            plan = self._passing.get(plan_id)
        if plan is not None:
            self._write_and_hold(plan_id, plan)
            with self._lock:
                self._passing.pop(plan_id, None)

    def let_go(self, plan_id: str) -> None:
        """Allow a plan of a gesture to be dropped, unwritten, once it is not among the newest any more."""
        with self._lock:
            self._let_go.add(plan_id)
            self._let_go &= self._passing.keys()

    def _write_and_hold(self, plan_id: str, plan: Plan) -> None:
        self._hold(plan_id, self._write(plan_id, plan))

    def _hold(self, plan_id: str, plan: Plan | PackedPlan) -> None:
        """Keep a plan in memory as the newest one."""
        with self._lock:
            self._live[plan_id] = plan
            self._live.move_to_end(plan_id)
            if len(self._live) > self._live_max:
                self._live.popitem(last=False)

    def plan(self, plan_id: str) -> Plan:
        """Return the plan with this id; raise `UnknownPlanError` if there is none."""
        with self._lock:
            held = self._live.get(plan_id) or self._passing.get(plan_id)
        if isinstance(held, Plan):
            return held
        plan = self._stored(plan_id) if held is None else held.plan()
        self._hold(plan_id, plan)
        return plan

    def _stored(self, plan_id: str) -> Plan:
        if "\0" in plan_id:  # PostgreSQL knows no zero character
            raise UnknownPlanError(plan_id)
        with self._database.reading("the plan could not be read") as session:
            packed = session.scalar(select(PlanRow.content).where(PlanRow.id == plan_id))
        if packed is None:
            raise UnknownPlanError(plan_id)
        return unpacked(packed)

    def drop(self, plan_id: str) -> None:
        """Drop a plan, if it is there."""
        with self._lock:
            self._live.pop(plan_id, None)
            if self._passing.pop(plan_id, None) is not None:
                return
        with self._database.writing("the plan could not be dropped", is_synced=False, is_lasting=False) as session:
            session.execute(delete(PlanRow).where(PlanRow.id == plan_id))

    def _write(self, plan_id: str, plan: Plan) -> PackedPlan:
        packed = PackedPlan.of(plan)
        self._write_content(plan_id, packed.content)
        return packed

    def _write_content(self, plan_id: str, content: bytes) -> None:
        try:
            self._write_row(plan_id, content)
        except FoldingError as error:
            _log.warning("%s", error)

    def _write_row(self, plan_id: str, content: bytes) -> None:
        row = {"id": plan_id, "size": len(content), "content": content}
        with self._database.writing("the plan could not be kept", is_synced=False, is_lasting=False) as session:
            session.execute(insert(PlanRow), row)
            with self._lock:
                self._added += 1
                is_due = self._added % min(_DROP_EVERY, self._capacity) == 0
            if is_due:
                drop_oldest(session, PlanRow, self._capacity, self._capacity_bytes)
