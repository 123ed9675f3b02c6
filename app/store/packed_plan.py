"""A plan packed for keeping: its JSON, compressed, which takes a sixth of the memory of the object (measured)."""

import threading
import zlib
from collections import OrderedDict
from dataclasses import dataclass

from pydantic_core import from_json, to_json

from planner.robots.load_robot import Stamp, robot_stamp
from planner.task.plan import Plan
from planner.task.task import Task

_ANSWERS_MAX = 64
"""Number of tasks whose answers are remembered, packed: 0.1 MB each, as objects 0.3 to 0.7 MB (measured)."""

_ZIP_LEVEL = 1
"""Compression level. Higher ones take longer and save only 5 % more (measured)."""


@dataclass(frozen=True, slots=True)
class PackedPlan:
    """A plan, packed.

    Attributes:
        content: the plan as compressed JSON; a later Pleat knows the version in it.
        answer: the plan as REST tells it, as JSON.
    """

    content: bytes
    answer: bytes

    @staticmethod
    def of(plan: Plan) -> "PackedPlan":
        """Pack a plan."""
        return PackedPlan(zlib.compress(to_json(plan.to_dict()), _ZIP_LEVEL), to_json(plan.answer()))

    def plan(self) -> Plan:
        """Return the plan, unpacked."""
        return unpacked(self.content)


def unpacked(content: bytes) -> Plan:
    """Return the plan whose compressed JSON is given."""
    return Plan.from_dict(from_json(zlib.decompress(content)))


class Answers:
    """The answers to the tasks asked last, if more search cannot improve them; safe to use from any thread."""

    def __init__(self) -> None:
        """Start empty."""
        self._answers: OrderedDict[tuple[Task, Stamp], PackedPlan] = OrderedDict()
        self._lock = threading.Lock()

    def add(self, task: Task, answer: PackedPlan) -> None:
        """Remember the answer to a task; forget the one that was asked for least recently if there are too many."""
        key = task, robot_stamp(task.robot)
        with self._lock:
            self._answers[key] = answer
            if len(self._answers) > _ANSWERS_MAX:
                self._answers.popitem(last=False)

    def get(self, task: Task) -> Plan | None:
        """Return the answer to a task, if it is remembered and the robot is still the same."""
        key = task, robot_stamp(task.robot)
        with self._lock:
            if key not in self._answers:
                return None
            self._answers.move_to_end(key)
            packed = self._answers[key]
        return packed.plan()
