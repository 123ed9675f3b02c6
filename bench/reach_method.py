"""The interface of the methods that decide whether the left arm can take poses."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from bench.reach_queries import Queries
from planner.geometry.pose import FloatArray

Joints: TypeAlias = Sequence[FloatArray | None]
"""For each query seven joints (rad), or None for a "no"."""

Answering: TypeAlias = Callable[[], Callable[[], Joints]]
"""Answers its queries, which is timed, and returns a function that finds their joints, which is not timed."""


@dataclass(frozen=True, slots=True)
class Method:
    """A method of answering queries.

    Attributes:
        name: its name in the table.
        prepare: makes an answering function for queries; its own time is not measured.
        is_of_pinches: whether it answers the planner's own approaches only.
        is_slow: whether it is given only a few of the queries.
        is_repeatable: whether the same query takes as long when it is repeated.
    """

    name: str
    prepare: Callable[[Queries], Answering]
    is_of_pinches: bool = False
    is_slow: bool = False
    is_repeatable: bool = True
