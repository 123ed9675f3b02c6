"""A technology to tell what arms reach: what the compiled queries ask, answered for one kind of arm."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class ReachTechnology:
    """The kernels that answer for one kind of arm.

    The arm and the query in one approach are named tuples, each of a type of its own: passed to compiled code, they
    tell which technology it is.

    Attributes:
        arm: the type of an arm, or of all arms of a robot together.
        query: the type of the constants of the queries in one approach.
        space_for: arm -> working memory for its queries.
        query_of: arm, label, comfort radius (m) -> the query in the approach of a label.
        is_in_height: query, place -> whether the place's height is one that the arm can have; may be approximate.
        is_in_length: query, place, standoff -> whether the arm is long enough for a place, ignoring most limits.
        is_within_margin: query, arm, working memory, place, standoff -> whether the place is within the comfort radius.
    """

    arm: type
    query: type
    space_for: Callable[..., Any]
    query_of: Callable[..., Any]
    is_in_height: Callable[..., bool]
    is_in_length: Callable[..., bool]
    is_within_margin: Callable[..., bool]
