"""A plan packed for keeping: its JSON, compressed, which takes a sixth of the memory of the object (measured)."""

import zlib
from dataclasses import dataclass

from pydantic_core import from_json, to_json

from planner.task.plan import Plan

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
