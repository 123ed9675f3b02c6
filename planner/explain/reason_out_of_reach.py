"""Report points out of reach: the place, the shortfall, its cause, and a remedy."""

from collections.abc import Mapping
from dataclasses import replace
from enum import StrEnum
from typing import Any

import numpy as np

from planner.explain.reason_attempt import FURTHEST_M, Miss, explained, least_shift
from planner.geometry.driving import STANDOFFS_PER_M
from planner.geometry.pose import Point3, Pose2, point3
from planner.geometry.tolerance import ANGLE_RAD
from planner.primitives.context import Context
from planner.primitives.state import State
from planner.task.reason import Code, Reason
from planner.words.catalogue import worded


def out_of_reach(context: Context, fold: int, miss: Miss) -> Reason:
    """Return what the closest attempt lacked, as a reason."""
    miss = explained(context, miss)
    found, trial = miss.shortfall, miss.trial
    station, pose = context.scene.stations[miss.state.station]
    arm = context.reach.arm_names[trial.arms[miss.grip]]
    point = point3(trial.tools[miss.grip, miss.waypoint])
    shift_m, shift_towards = (None if found.is_at_least else least_shift(context, miss)) or (None, None)
    same: dict[str, Any] = {
        "arm": arm,
        "station": station or None,
        "back_off_m": miss.standoff / STANDOFFS_PER_M,
        "cause": found.cause,
        "joint": found.joint,
        "short_by_m": found.short_by_m,
        "is_at_least": found.is_at_least,
        "comfort_m": found.comfort_m,
    }
    values = {
        **same,
        "at": list(point),
        "moment": _moment(miss).value,
        "demand": miss.demand.value,
        "towards": list(found.towards),
        "wanted_comfort_m": context.reach.comfort_m,
        **dragged(miss.state),
        "shift_m": None,
        "shift_towards": None,
        "movable": None,
        "enough_comfort_m": None,
        "enough_cone_rad": None,
        "tried_m": FURTHEST_M,
    }
    return Reason(
        fold,
        Code.OUT_OF_REACH,
        worded("out_of_reach", values, context.sequence.folds, fold),
        point=point,
        towards=_turned(pose, found.towards),
        approach=context.reach.approaches[found.approach],
        offset_m=miss.state.offset,
        shift_m=shift_m,
        shift_towards=None if shift_towards is None else _turned(pose, shift_towards),
        **same,
    )


class _Moment(StrEnum):
    """A hand's position on its path."""

    PICK = "pick"
    PLACE = "place"
    TOP = "top"
    UP = "up"
    DOWN = "down"


def _moment(miss: Miss) -> _Moment:
    """Return where on its path the hand is that lacks something."""
    last, sweep = len(miss.trial.sweeps) - 1, float(miss.trial.sweeps[miss.waypoint])
    if miss.waypoint == 0:
        return _Moment.PICK
    if miss.waypoint == last:
        return _Moment.PLACE
    if abs(sweep - 1.0) <= ANGLE_RAD:
        return _Moment.TOP
    return _Moment.UP if sweep < 1.0 else _Moment.DOWN


def removed_by(reason: Reason, context: Context, kinds: tuple[str, ...]) -> Reason:
    """Return what was out of reach, with the repair that was tried and works.

    Args:
        reason: the reason, with the shift that the hands' whole path needs.
        context: the planning context.
        kinds: what can be moved by the shift: "cloth" or "station", "table" or "torso"; empty where nothing that was
            tried works, but arms long enough would.
    """
    shift, towards = reason.shift_m, reason.shift_towards
    pose = dict(context.scene.stations).get(reason.station or "")
    if not kinds or shift is None or towards is None or pose is None:
        return _advised(reason, context, {"movable": []}, shift_m=None)
    in_base = point3(pose.to_inner(np.array(towards) + np.array([pose.x_m, pose.y_m, 0.0])))
    return _advised(reason, context, {"movable": list(kinds), "shift_towards": list(in_base)}, shift_m=shift)


def reached_with_comfort(reason: Reason, context: Context, comfort_m: float) -> Reason:
    """Return a reason with the smaller comfort radius that was tried and brings the point into reach.

    Its message still says how much comfort the point has.
    """
    advised = _advised(reason, context, {"enough_comfort_m": comfort_m}, shift_m=None)
    return replace(advised, comfort_m=comfort_m)


def reached_with_cone(reason: Reason, context: Context, cone_rad: float) -> Reason:
    """Return a reason with the wider approach cone that was tried and brings the point into reach."""
    return _advised(reason, context, {"enough_cone_rad": cone_rad}, shift_m=None)


def enough_with_others(reason: Reason, context: Context) -> Reason:
    """Return a reason whose change is not enough alone, but only with what else its set has."""
    return _advised(reason, context, {"is_enough": False})


def _advised(reason: Reason, context: Context, values: Mapping[str, Any], **same: float | None) -> Reason:
    """Return a reason that also says what would help; `same` are numbers that the reason and its message both have."""
    said = {**reason.says.values, **values, **same}
    says = worded(reason.says.code, said, context.sequence.folds, reason.fold)
    changed = replace(reason, says=says, **same)  # type: ignore[arg-type]
    return replace(changed, shift_towards=None) if changed.shift_m is None else changed


def dragged(state: State) -> dict[str, Any]:
    """Return where drags had brought the cloth, as values for a message."""
    return {"dragged": list(state.offset), "is_held": state.is_dragged}


def _turned(pose: Pose2, direction: Point3) -> Point3:
    """Rotate a direction from a base's frame to the table frame."""
    return point3(pose.to_outer(np.array(direction)) - pose.to_outer(np.zeros(3)))
