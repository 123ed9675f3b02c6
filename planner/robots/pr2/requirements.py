"""The requirements on a place of the tool, and the test whether a tool pose meets them. Compiled."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.pr2.aim import ToolPose, aim_at
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.arm_gap import comfort_gap
from planner.robots.pr2.closed_comfort import is_comfortable
from planner.robots.pr2.pan_arcs import MOST_ARCS
from planner.robots.pr2.posture_room import Room, has_room_about


class Requirements(NamedTuple):
    """The requirements on a place.

    Attributes:
        axes: the approach axes allowed, shape (k, 3).
        labels: the labels of the axes in the room's memory, shape (k,).
        comfort: the comfort radius (m).
        room: the obstacles to the arm's postures.
    """

    axes: FloatArray
    labels: NDArray[np.int64]
    comfort: float
    room: Room


class Scratch(NamedTuple):
    """Scratch space.

    Attributes:
        arcs: shape (MOST_ARCS, 2).
        hint: the pan that served last (rad), and its branch, shape (2,).
    """

    arcs: FloatArray
    hint: FloatArray


@kernel
def scratch_for(shape: ArmShape) -> Scratch:
    """Return scratch space for a search that has not begun."""
    return Scratch(np.empty((MOST_ARCS, 2)), np.array([0.5 * (shape.pan.low + shape.pan.high), 1.0]))


@kernel
def aim_of(shape: ArmShape, query: Requirements, point: FloatArray, approach: int) -> ToolPose:
    """Return the tool pose that brings the tool to a point in an approach."""
    axis = query.axes[approach]
    return aim_at(shape, point[0], point[1], point[2], axis[0], axis[1], axis[2])


@kernel
def aims_gap(shape: ArmShape, query: Requirements, point: FloatArray, approach: int) -> float:
    """Return a lower bound on how far a tool point is from the comfort radius (m), see `comfort_gap`."""
    return comfort_gap(shape, aim_of(shape, query, point, approach), query.comfort)


@kernel
def meets_query(
    shape: ArmShape, query: Requirements, aim: ToolPose, approach: int, comfort: float, scratch: Scratch
) -> tuple[bool, int]:
    """Return whether a tool pose meets the requirements in its approach, with a comfort radius; queries made."""
    found, queries = is_comfortable(shape, aim, comfort, scratch.arcs, scratch.hint)
    return found and has_room_about(shape, query.room, query.labels[approach], aim, scratch.arcs), queries


@kernel
def rooms_tested(query: Requirements) -> int:
    """Return the number of cells tested so far for whether the body leaves the arm room."""
    return int(query.room.memory.entries[0])
