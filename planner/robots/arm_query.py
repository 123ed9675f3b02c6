"""The questions that the search for reach puts to an arm, whatever kind of arm it is. Compiled.

An arm comes to the compiled queries as its numbers: of a closed form (`closed_comfort`), or of a reach map
(`mapped_comfort`). Which of the two answers is chosen when a query is compiled, by the type of the numbers.
"""

from typing import Any, TypeAlias

import numpy as np
from numba import types
from numba.extending import overload

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.closed_comfort import (
    ClosedQuery,
    closed_in_height,
    closed_in_length,
    closed_query,
    closed_within_margin,
)
from planner.robots.mapped_comfort import (
    MappedArms,
    MappedQuery,
    MappedSpace,
    mapped_in_height,
    mapped_in_length,
    mapped_query,
    mapped_space,
    mapped_within_margin,
)
from planner.robots.pan_arcs import MOST_ARCS
from planner.robots.place import Place
from planner.robots.posture_room import Room

ArmNumbers: TypeAlias = FloatArray | MappedArms
"""An arm for the compiled queries, or, with maps, all arms of a robot."""

ArmQuery: TypeAlias = ClosedQuery | MappedQuery
"""The constants of the queries in one approach."""

Space: TypeAlias = FloatArray | MappedSpace
"""Working memory of the queries."""


def space_for(_arm: ArmNumbers) -> Space:
    """Return working memory for the queries of an arm."""
    raise NotImplementedError("compiled alone")


def query(
    _arm: ArmNumbers, _shoulder: FloatArray, _axes: FloatArray, _label: int, _comfort: float, _step: int
) -> ArmQuery:
    """Return the query in the approach of a label."""
    raise NotImplementedError("compiled alone")


def is_in_height(_ask: ArmQuery, _place: Place) -> bool:
    """Return whether a place's height is one that the arm can have; an approximate test."""
    raise NotImplementedError("compiled alone")


def is_in_length(_ask: ArmQuery, _place: Place, _standoff: int) -> bool:
    """Return whether the arm is long enough for a place, ignoring most limits."""
    raise NotImplementedError("compiled alone")


def is_within_margin(
    _ask: ArmQuery, _hints: FloatArray, _room: Room, _space: Space, _place: Place, _standoff: int
) -> bool:
    """Return whether a place is within the comfort radius from a standoff."""
    raise NotImplementedError("compiled alone")


def _is_mapped(kind: types.Type) -> bool:
    return getattr(kind, "instance_class", None) in (MappedArms, MappedQuery)


@kernel
def _arcs() -> FloatArray:
    return np.empty((MOST_ARCS, 2))


@overload(space_for, strict=False)
def _space_for(_arm: types.Type) -> Any:  # noqa: ANN401
    return (lambda _arm: mapped_space(_arm)) if _is_mapped(_arm) else (lambda _arm: _arcs())


@overload(query, strict=False)
def _query(
    _arm: types.Type,
    _shoulder: types.Type,
    _axes: types.Type,
    _label: types.Type,
    _comfort: types.Type,
    _step: types.Type,
) -> Any:  # noqa: ANN401
    if _is_mapped(_arm):
        return lambda _arm, _shoulder, _axes, _label, _comfort, _step: mapped_query(_arm, _label, _comfort, _step)
    return lambda _arm, _shoulder, _axes, _label, _comfort, _step: closed_query(
        _arm, _shoulder, _axes, _label, _comfort, _step
    )


@overload(is_in_height, strict=False)
def _is_in_height(_ask: types.Type, _place: types.Type) -> Any:  # noqa: ANN401
    if _is_mapped(_ask):
        return lambda _ask, _place: mapped_in_height(_ask, _place)
    return lambda _ask, _place: closed_in_height(_ask, _place)


@overload(is_in_length, strict=False)
def _is_in_length(_ask: types.Type, _place: types.Type, _standoff: types.Type) -> Any:  # noqa: ANN401
    if _is_mapped(_ask):
        return lambda _ask, _place, _standoff: mapped_in_length(_ask, _place, _standoff)
    return lambda _ask, _place, _standoff: closed_in_length(_ask, _place, _standoff)


@overload(is_within_margin, strict=False)
def _is_within_margin(
    _ask: types.Type,
    _hints: types.Type,
    _room: types.Type,
    _space: types.Type,
    _place: types.Type,
    _standoff: types.Type,
) -> Any:  # noqa: ANN401
    if _is_mapped(_ask):
        return lambda _ask, _hints, _room, _space, _place, _standoff: mapped_within_margin(
            _ask, _space, _place, _standoff
        )
    return lambda _ask, _hints, _room, _space, _place, _standoff: closed_within_margin(
        _ask, _hints, _room, _space, _place, _standoff
    )
