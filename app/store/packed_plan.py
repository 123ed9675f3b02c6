"""A plan packed for keeping: its JSON, compressed, which takes a sixth of the memory of the object (measured)."""

import math
import threading
import zlib
from collections import OrderedDict
from dataclasses import dataclass, replace

from pydantic_core import from_json, to_json

from planner.robots.load_robot import Stamp, robot_stamp
from planner.task.plan import Plan
from planner.task.task import TIME_LIMIT_S, Limits, Task

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
        needs_s: the time that the whole search for it takes (s); infinite for one that was cut short.
    """

    content: bytes
    answer: bytes
    needs_s: float

    @staticmethod
    def of(plan: Plan) -> "PackedPlan":
        """Pack a plan."""
        content = zlib.compress(to_json(plan.to_dict()), _ZIP_LEVEL)
        took = plan.statistics
        needs_s = math.inf if took.is_cut_short else took.search_time_s + took.joint_time_s
        return PackedPlan(content, to_json(plan.answer()), needs_s)

    def plan(self) -> Plan:
        """Return the plan, unpacked."""
        return unpacked(self.content)


def unpacked(content: bytes) -> Plan:
    """Return the plan whose compressed JSON is given."""
    return Plan.from_dict(from_json(zlib.decompress(content)))


class Answers:
    """The answers to the tasks asked last, if more search cannot improve them; safe to use from any thread.

    Beside them are the plans of the proposals made last: whoever takes one asks for its task.
    """

    def __init__(self) -> None:
        """Start empty."""
        self._answers: OrderedDict[tuple[Task, Stamp], PackedPlan] = OrderedDict()
        self._proposed: OrderedDict[tuple[Task, Stamp], PackedPlan] = OrderedDict()
        self._lock = threading.Lock()

    def add(self, task: Task, answer: PackedPlan) -> None:
        """Remember the answer to a task, unless more search may improve it.

        Forget the one that was asked for least recently if there are too many.
        """
        if math.isinf(answer.needs_s):
            return
        with self._lock:
            self._answers[_key(task)] = answer
            if len(self._answers) > _ANSWERS_MAX:
                self._answers.popitem(last=False)

    def propose(self, task: Task, plan: PackedPlan) -> None:
        """Remember a plan with which a task was proposed, though more search may find a quicker one."""
        with self._lock:
            self._proposed[_without_limits(task)] = plan
            if len(self._proposed) > _ANSWERS_MAX:
                self._proposed.popitem(last=False)

    def proposed(self, task: Task) -> PackedPlan | None:
        """Return the plan with which a task was proposed, if it was lately and the robot is the same."""
        with self._lock:
            return self._proposed.get(_without_limits(task))

    def get(self, task: Task) -> PackedPlan | None:
        """Return the answer to a task if it is remembered, takes no longer than allowed, and the robot is the same."""
        key = _key(task)
        with self._lock:
            answer = self._answers.get(key)
            if answer is None or answer.needs_s > task.limits.time_limit_s:
                return None
            self._answers.move_to_end(key)
            return answer


def _key(task: Task) -> tuple[Task, Stamp]:
    """Return what the answer to a task depends on if its time limit is not reached."""
    limits = replace(task.limits, time_limit_s=TIME_LIMIT_S[1])
    return replace(task, limits=limits), robot_stamp(task.robot)


def _without_limits(task: Task) -> tuple[Task, Stamp]:
    """Return the part of a task that decides whether a plan is valid for it: all but the limits of the search."""
    return replace(task, limits=Limits(task.limits.comfort_radius_m)), robot_stamp(task.robot)
