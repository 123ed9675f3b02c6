"""Put into a sentence what was out of reach: where, by how much, why, and what would help."""

import math
from collections.abc import Mapping
from dataclasses import replace
from enum import StrEnum
from typing import Any

import numpy as np

from planner.explain.reason_attempt import Demand, Miss, explained
from planner.explain.reason_remedy import FURTHEST_M, remedy
from planner.geometry.pose import FloatArray, Point3, Pose2
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.message import Message
from planner.primitives.context import BACK_OFFS_PER_M, Context
from planner.primitives.state import State
from planner.task.reason import Code, Reason

_SHORT_M = 0.0095
"""Lengths below this are told to the millimetre (m)."""

_OBLIQUE = 0.5
"""A direction component below this is left out of the words."""


def counted_hands(count: int) -> str:
    """Return a number of hands in words."""
    return "one hand" if count == 1 else f"{count} hands"


def stand_words(station: str) -> str:
    """Return a station in words; the nameless one is where the base stands at the start."""
    return station or "where the base stands"


def out_of_reach(context: Context, fold: int, miss: Miss) -> Reason:
    """Return what the closest attempt lacked, as a reason."""
    miss = explained(context, miss)
    found, trial = miss.shortfall, miss.trial
    label = context.sequence.folds[fold].label
    station, pose = context.scene.stations[miss.state.station]
    arm = context.reach.arm_names[trial.arms[miss.grip]]
    point = _point(trial.tools[miss.grip, miss.waypoint])
    needed = None if found.is_at_least else remedy(context, miss)
    text = (
        f"{label}: the {arm} grip at ({point[0]:.2f}, {point[1]:.2f}) m, {height_words(point[2])} "
        f"{_AT[_moment(miss)]}, {_lack(context, miss)}; "
        f"closest: {stand_words(station)}, backed off {miss.back_off / BACK_OFFS_PER_M:.2f} m{carried(miss.state)}"
    )
    values = {
        "arm": arm,
        "at": list(point),
        "moment": _moment(miss).value,
        "demand": miss.demand.value,
        "cause": found.cause,
        "joint": found.joint,
        "towards": list(found.towards),
        "short_by_m": found.short_by_m,
        "is_at_least": found.is_at_least,
        "comfort_m": found.comfort_m,
        "wanted_comfort_m": context.reach.comfort_m,
        "station": station or None,
        "back_off_m": miss.back_off / BACK_OFFS_PER_M,
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
        Message("out_of_reach", text, values),
        cause=found.cause,
        joint=found.joint,
        point=point,
        short_by_m=found.short_by_m,
        is_at_least=found.is_at_least,
        towards=_turned(pose, found.towards),
        arm=arm,
        station=station or None,
        back_off_m=miss.back_off / BACK_OFFS_PER_M,
        approach=context.reach.approaches[found.approach],
        offset_m=miss.state.offset,
        shift_m=None if needed is None else needed.distance_m,
        shift_towards=None if needed is None else _turned(pose, needed.towards),
        comfort_m=found.comfort_m,
    )


class _Moment(StrEnum):
    """Where a hand is on its path."""

    PICK = "pick"
    PLACE = "place"
    TOP = "top"
    UP = "up"
    DOWN = "down"


_AT = {
    _Moment.PICK: "where it is picked up",
    _Moment.PLACE: "where it is laid down",
    _Moment.TOP: "at the top of its way, as high as it is far from the fold line",
    _Moment.UP: "on its way up",
    _Moment.DOWN: "on its way down",
}


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


def height_words(z: float) -> str:
    """Return in words how high a point is over the table top (m); negative below it, where cloth hangs."""
    return f"{z:.2f} m over the table" if z >= 0.0 else f"{-z:.2f} m below the table's top"


def _lack(context: Context, miss: Miss) -> str:
    """Return in words by how much a point is out of reach, and why."""
    found = miss.shortfall
    limit = None if found.joint is None else f"{found.joint} limit"
    demand = {
        Demand.ALONE: "",
        Demand.ONE_ORIENTATION: " in the orientation that suits its way best",
        Demand.DRIVING: " from where the base is by then",
        Demand.WITH_THE_OTHER_HAND: " from where the other hand has what it needs",
    }[miss.demand]
    decimals = 2 if found.short_by_m >= _SHORT_M else 3
    by = ("at least " if found.is_at_least else "") + f"{found.short_by_m:.{decimals}f}"
    if found.cause == "comfort_only":
        return (
            f"can be reached, but with {_down(found.comfort_m or 0.0)} m of comfort only, not "
            f"{context.reach.comfort_m:g} m{demand} ({limit or 'too far'}): it is {by} m out of comfort"
        )
    why = {
        "too_far": "too far",
        "too_near": "too near",
        "joint_limit": "joint limit",
        "own_body": "the robot's own body is in the way",
    }[found.cause]
    if found.cause in ("too_far", "too_near") and not found.is_at_least and abs(found.towards[2]) > _OBLIQUE:
        why += " down" if found.towards[2] > 0.0 else " up"
    because = why if limit is None else f"{why}, {limit}"
    return f"is {by} m out of reach{demand} ({because})"


def remedied_by(reason: Reason, pose: Pose2, kinds: tuple[str, ...]) -> Reason:
    """Return what was out of reach, with the repair that was tried and works.

    Args:
        reason: the reason, with the shift that the hands' whole path needs.
        pose: the pose of the station that it is seen from.
        kinds: what can be moved by the shift: "cloth" or "station", "table" or "torso"; empty where nothing that was
            tried works, but arms long enough would.
    """
    shift, towards = reason.shift_m, reason.shift_towards
    if not kinds or shift is None or towards is None:
        advice = f"no shift of its way by up to {FURTHEST_M:g} m was found that brings it about: fold less at once"
        if reason.is_at_least:
            advice = "place the cloth or a station so that it is nearer"
        return replace(_advised(reason, advice, {"movable": []}), shift_m=None, shift_towards=None)
    decimals = 2 if shift >= _SHORT_M else 3
    in_base = _point(pose.to_inner(np.array(towards) + np.array([pose.x_m, pose.y_m, 0.0])))
    up = towards[2] > 0.0
    words = {
        "cloth": "move the cloth",
        "station": "the station" if "cloth" in kinds else "move the station",
        "table": "raise the table" if up else "lower the table",
        "torso": "lower the torso" if up else "raise the torso",
    }
    how = " or ".join(words[kind] for kind in kinds)
    advice = f"all of its way is in reach {shift:.{decimals}f} m {_where_to(in_base)}: {how}"
    return _advised(reason, advice, {"movable": list(kinds), "shift_m": shift, "shift_towards": list(in_base)})


def reached_with_comfort(reason: Reason, comfort_m: float) -> Reason:
    """Return a reason with the smaller comfort radius that was tried and brings the point into reach."""
    advice = f"with {_down(comfort_m)} m of comfort it can be done"
    told = _advised(reason, advice, {"movable": None, "enough_comfort_m": comfort_m})
    return replace(told, comfort_m=comfort_m, shift_m=None, shift_towards=None)


def reached_with_cone(reason: Reason, cone_rad: float) -> Reason:
    """Return a reason with the wider approach cone that was tried and brings the point into reach."""
    advice = f"with pinches from within {math.degrees(cone_rad):.0f} degrees of the way into the cloth it can be done"
    told = _advised(reason, advice, {"movable": None, "enough_cone_rad": cone_rad})
    return replace(told, shift_m=None, shift_towards=None)


def _advised(reason: Reason, advice: str, values: Mapping[str, Any]) -> Reason:
    """Return a reason that also says what would help."""
    says = reason.says
    return replace(reason, says=Message(says.code, f"{says.text}; {advice}", {**says.values, **values}))


def _where_to(towards: Point3) -> str:
    """Return a direction of the base frame in words."""
    words = []
    for component, forwards, backwards in zip(
        towards,
        ("further from the robot", "further to its left", "higher"),
        ("nearer to the robot", "further to its right", "lower"),
        strict=True,
    ):
        if abs(component) > _OBLIQUE:
            words.append(forwards if component > 0.0 else backwards)
    return " and ".join(words) or "nearer to its shoulder"


def dragged(state: State) -> dict[str, Any]:
    """Return where drags had brought the cloth, as values of a message."""
    return {"dragged": list(state.offset), "is_held": state.is_dragged}


def carried(state: State) -> str:
    """Return where drags had brought the cloth, in words."""
    if math.hypot(*state.offset) <= LENGTH_M:
        return ""
    x, y = (LENGTH_M * round(c / LENGTH_M) + 0.0 for c in state.offset)
    hold = " and held on to" if state.is_dragged else ""
    return f" (the cloth dragged by ({x:.2f}, {y:.2f}) m from where it starts{hold})"


def _down(number: float) -> str:
    """Return a number rounded down to three decimals."""
    return f"{math.floor(number * 1000.0 + LENGTH_M) / 1000.0:.3f}"


def _turned(pose: Pose2, direction: Point3) -> Point3:
    """Rotate a direction from a base's frame to the table frame."""
    return _point(pose.to_outer(np.array(direction)) - pose.to_outer(np.zeros(3)))


def _point(row: FloatArray) -> Point3:
    return (float(row[0]), float(row[1]), float(row[2]))
