"""A place within the comfort radius of an arm with a closed form: the PR2's. Compiled.

A place also counts only if the body leaves the arm room there (see `planner.robots.pr2.posture_room`).
"""

from typing import NamedTuple, TypeAlias

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.kernels import kernel
from planner.robots.place import STANDOFF_STEP, Place, in_steps
from planner.robots.pr2.aim import ToolPose, aim_at, beside, is_within_height, is_within_length
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.joint_slack import ring_slack
from planner.robots.pr2.kernel import is_reachable_near, shape_of
from planner.robots.pr2.pan_arcs import MOST_ARCS
from planner.robots.pr2.posture_room import Room, has_room_about, may_be_hindered
from planner.robots.reach_technology import ReachTechnology

Arcs: TypeAlias = FloatArray
"""Scratch space, shape (MOST_ARCS, 2)."""


class ClosedArm(NamedTuple):
    """The left arm for the compiled queries, in few arrays: passing many costs more than a query.

    Attributes:
        numbers: its lengths and limits, see `numbers_of`, shape (37,).
        shoulder: its shoulder, base frame (m), shape (3,).
        axes: all approach axes, shape (m, 3).
        hints: for each label the pan that served last (rad) and its branch, shape (1 + m, 2); no answer depends on it.
        room: the obstacles to its postures.
    """

    numbers: FloatArray
    shoulder: FloatArray
    axes: FloatArray
    hints: FloatArray
    room: Room


def no_hints(approaches: int) -> FloatArray:
    """Return the hints of a plan that has not queried any of so many approaches yet."""
    return np.tile((0.5, 1.0), (1 + approaches, 1))


class ClosedQuery(NamedTuple):
    """The constants of the queries in one approach; numbers alone, because those are passed on without cost.

    Attributes:
        shape: the arm.
        rest: the shoulder's offset from the grid of `LENGTH_M` (m).
        axis: the approach axis.
        label: the approach's label in the memory, from 1 on.
        comfort: the comfort radius (m).
    """

    shape: ArmShape
    rest: tuple[float, float, float]
    axis: tuple[float, float, float]
    label: int
    comfort: float


@kernel
def _space_for(_arm: ClosedArm) -> Arcs:
    return np.empty((MOST_ARCS, 2))


@kernel
def _query_of(arm: ClosedArm, label: int, comfort: float) -> ClosedQuery:
    shoulder, axes = arm.shoulder, arm.axes
    rest = (
        shoulder[0] - in_steps(shoulder[0]) * LENGTH_M,
        shoulder[1] - in_steps(shoulder[1]) * LENGTH_M,
        shoulder[2] - in_steps(shoulder[2]) * LENGTH_M,
    )
    axis = (axes[label - 1, 0], axes[label - 1, 1], axes[label - 1, 2])
    return ClosedQuery(shape_of(arm.numbers), rest, axis, label, comfort)


@kernel
def aim_from(ask: ClosedQuery, place: Place, standoff: int) -> ToolPose:
    """Return the tool pose at a place with the base at a standoff."""
    x, rest, axis = place.x + standoff * STANDOFF_STEP, ask.rest, ask.axis
    ahead, left, up = x * LENGTH_M - rest[0], place.y * LENGTH_M - rest[1], place.z * LENGTH_M - rest[2]
    return aim_at(ask.shape, ahead, left, up, axis[0], axis[1], axis[2])


@kernel
def _is_in_height(ask: ClosedQuery, place: Place) -> bool:
    return is_within_height(ask.shape, aim_from(ask, place, 0))


@kernel
def _is_in_length(ask: ClosedQuery, place: Place, standoff: int) -> bool:
    aim = aim_from(ask, place, standoff)
    return is_within_length(ask.shape, aim) and is_within_height(ask.shape, aim)


@kernel
def _is_within_margin(ask: ClosedQuery, arm: ClosedArm, arcs: Arcs, place: Place, standoff: int) -> bool:
    aim = aim_from(ask, place, standoff)
    answer: bool = is_comfortable(ask.shape, aim, ask.comfort, arcs, arm.hints[ask.label])[0]
    if answer and may_be_hindered(aim):
        answer = has_room_about(ask.shape, arm.room, ask.label, aim, arcs)
    return answer


@kernel
def is_comfortable(
    shape: ArmShape, aim: ToolPose, comfort: float, arcs: FloatArray, hint: FloatArray
) -> tuple[bool, int]:
    """Return whether a tool pose and four on the circle of radius `comfort` round it are reachable; queries made.

    Mostly the pan that served last, `hint`, serves all five. If not, the pose that it serves least is tested first.
    """
    if comfort <= 0.0:
        return is_reachable_near(shape, aim, arcs, hint), 1
    least, worst = ring_slack(shape, aim, comfort, hint[0], hint[1])
    if least >= 0.0:
        return True, 5
    pan, branch = hint
    if not is_reachable_near(shape, beside(aim, comfort, worst), arcs, hint):
        return False, 1
    if ring_slack(shape, aim, comfort, hint[0], hint[1])[0] >= 0.0:
        return True, 5
    for number in range(5):
        if number != worst and not is_reachable_near(shape, beside(aim, comfort, number), arcs, hint):
            hint[0], hint[1] = pan, branch
            return False, 2 + number - (1 if number > worst else 0)
    return True, 5


CLOSED_FORM = ReachTechnology(
    ClosedArm, ClosedQuery, _space_for, _query_of, _is_in_height, _is_in_length, _is_within_margin
)
