"""A way to answer whether the left arm can take poses, whoever's it is."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from bench.reach_queries import Queries
from planner.geometry.pose import FloatArray

Joints: TypeAlias = Sequence[FloatArray | None]
"""For each query seven joints (rad), or None for a "no"."""

Answering: TypeAlias = Callable[[], Callable[[], Joints]]
"""Answers the queries that it was made for, which is timed; gives what finds the joints behind them, which is not."""


@dataclass(frozen=True, slots=True)
class Method:
    """A way to answer.

    Attributes:
        name: what it is called in the table.
        prepare: from queries to what answers them; what it does itself is not timed.
        is_of_pinches: whether it answers the planner's own approaches only.
        is_slow: whether it is asked a few of the queries only.
        is_repeatable: whether the same question takes as long when it is asked again.
    """

    name: str
    prepare: Callable[[Queries], Answering]
    is_of_pinches: bool = False
    is_slow: bool = False
    is_repeatable: bool = True
