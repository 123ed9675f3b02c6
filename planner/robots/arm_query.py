"""The questions that the search for reach puts to an arm, whatever kind of arm it is. Compiled.

An arm comes to the compiled queries as a named tuple, of which every technology has its own. Which of them answers is
chosen when a query is compiled, by the type of that tuple.
"""

from typing import Any, TypeAlias

from numba.core import types
from numba.extending import overload

from planner.robots.mapped_comfort import REACH_MAPS, MappedArms, MappedQuery, MappedSpace
from planner.robots.place import Place
from planner.robots.pr2.closed_comfort import CLOSED_FORM, Arcs, ClosedArm, ClosedQuery

TECHNOLOGIES = (CLOSED_FORM, REACH_MAPS)

ArmNumbers: TypeAlias = ClosedArm | MappedArms
"""An arm for the compiled queries, or all arms of a robot."""

ArmQuery: TypeAlias = ClosedQuery | MappedQuery
"""The constants of the queries in one approach."""

Space: TypeAlias = Arcs | MappedSpace
"""Working memory of the queries."""

_BY_TYPE = {kind: technology for technology in TECHNOLOGIES for kind in (technology.arm, technology.query)}


def space_for(_arm: ArmNumbers) -> Space:
    """Return working memory for the queries of an arm."""
    raise NotImplementedError("compiled alone")


def query(_arm: ArmNumbers, _label: int, _comfort: float) -> ArmQuery:
    """Return the query in the approach of a label."""
    raise NotImplementedError("compiled alone")


def is_in_height(_ask: ArmQuery, _place: Place) -> bool:
    """Return whether a place's height is one that the arm can have; an approximate test."""
    raise NotImplementedError("compiled alone")


def is_in_length(_ask: ArmQuery, _place: Place, _standoff: int) -> bool:
    """Return whether the arm is long enough for a place, ignoring most limits."""
    raise NotImplementedError("compiled alone")


def is_within_margin(_ask: ArmQuery, _arm: ArmNumbers, _space: Space, _place: Place, _standoff: int) -> bool:
    """Return whether a place is within the comfort radius from a standoff."""
    raise NotImplementedError("compiled alone")


@overload(space_for, strict=False)
def _space_for(_arm: types.NamedTuple) -> Any:  # noqa: ANN401
    answer = _BY_TYPE[_arm.instance_class].space_for
    return lambda _arm: answer(_arm)


@overload(query, strict=False)
def _query(_arm: types.NamedTuple, _label: types.Type, _comfort: types.Type) -> Any:  # noqa: ANN401
    answer = _BY_TYPE[_arm.instance_class].query_of
    return lambda _arm, _label, _comfort: answer(_arm, _label, _comfort)


@overload(is_in_height, strict=False)
def _is_in_height(_ask: types.NamedTuple, _place: types.Type) -> Any:  # noqa: ANN401
    answer = _BY_TYPE[_ask.instance_class].is_in_height
    return lambda _ask, _place: answer(_ask, _place)


@overload(is_in_length, strict=False)
def _is_in_length(_ask: types.NamedTuple, _place: types.Type, _standoff: types.Type) -> Any:  # noqa: ANN401
    answer = _BY_TYPE[_ask.instance_class].is_in_length
    return lambda _ask, _place, _standoff: answer(_ask, _place, _standoff)


@overload(is_within_margin, strict=False)
def _is_within_margin(
    _ask: types.NamedTuple, _arm: types.NamedTuple, _space: types.Type, _place: types.Type, _standoff: types.Type
) -> Any:  # noqa: ANN401
    answer = _BY_TYPE[_ask.instance_class].is_within_margin
    return lambda _ask, _arm, _space, _place, _standoff: answer(_ask, _arm, _space, _place, _standoff)
