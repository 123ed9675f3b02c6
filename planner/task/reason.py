"""The reasons why there is no plan."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from planner.geometry.pose import Approach, Point2, Point3
from planner.json_form import STRICT, JsonForm
from planner.message import Message


class Code(StrEnum):
    """The constraint that rules out a fold."""

    TOO_MANY_GRIPS = "too_many_grips"
    OUT_OF_REACH = "out_of_reach"
    NOT_A_G_STATE = "not_a_g_state"
    SLIPS = "slips"
    COLLISION = "collision"
    GRIPS_TOO_CLOSE = "grips_too_close"
    RED_NEEDS_HOLD = "red_needs_hold"
    LINE_OFF_TABLE = "line_off_table"
    WAITS_FOR_FOLD = "waits_for_fold"


@dataclass(frozen=True, slots=True)
class Reason:
    """A reason why there is no plan, about one fold or about the whole.

    Attributes:
        fold: the fold's index, or None.
        code: the constraint.
        says: a sentence with the numbers, and these as data.
        cause: for a point out of reach: too far, too near, a joint's limit, the comfort radius only, the robot's own
            body; for a collision what the arm touches: the table, its own body, the other arm.
        joint: the joint that limits, where one does.
        point: the tool point that is out of reach or collides, otherwise a point of the cloth; table frame (m).
        short_by_m: the shortfall: how far the point, the line or the cloth would have to be displaced, how much wider
            a grip radius or the gap between two grips would have to be, how deep two parts are in each other (m).
        is_at_least: whether `short_by_m` is only a lower bound: nothing nearer that was tried helps.
        towards: for a point out of reach, the unit direction in which it would have to be displaced, table frame.
        arm: for a point out of reach, the arm that came closest; for a collision the arm that collides.
        station: for a point out of reach, the station from which the arm came closest.
        back_off_m: the base's standoff from that station (m).
        approach: for a point out of reach, the orientation of that hand, base frame; `short_by_m` is measured in it.
        offset_m: how far the cloth had been dragged from its place at the start, (x, y) in the table frame (m): `point`
            minus this is the point with the cloth at the start. None if the cloth's place does not matter.
        shift_m: how far the cloth must be moved, or for a point out of reach the station or the table the other way,
            to fix the set (m); None if no shift fixes it.
        shift_towards: the unit direction of that shift, table frame.
        comfort_m: with "comfort_only" the comfort radius with which the point can be reached; where a smaller one was
            tried and fixes the set, that one (m).
        needed_friction: the friction with which the cloth would not slip.
        needed_grip_radius_m: the grip radius with which the hands would hold all they must (m).
        set: the index of the correction set: reasons with one index must all be fixed together; fixing one set is
            enough. None: not tried.
        gives: what fixing the set achieves: a "plan", or the "fold" and all it waits for, or, for cloth that does not
            stay as it lies at the "start", that it does. None: not tried.
        change: the fields of the plan request that fix the set, replacing its own; None if no request can ask for the
            change, such as longer arms.
    """

    __pydantic_config__ = STRICT

    fold: int | None
    code: Code
    says: Message
    cause: str | None = None
    joint: str | None = None
    point: Point3 | None = None
    short_by_m: float | None = None
    is_at_least: bool = False
    towards: Point3 | None = None
    arm: str | None = None
    station: str | None = None
    back_off_m: float | None = None
    approach: Approach | None = None
    offset_m: Point2 | None = None
    shift_m: float | None = None
    shift_towards: Point3 | None = None
    comfort_m: float | None = None
    needed_friction: float | None = None
    needed_grip_radius_m: float | None = None
    set: int | None = None
    gives: str | None = None
    change: Mapping[str, Any] | None = None

    @property
    def message(self) -> str:
        """The sentence."""
        return self.says.text

    @property
    def is_tried(self) -> bool:
        """Whether its removal has been tried; a fold that waits for another is not tried for itself."""
        return self.set is not None or self.code is Code.WAITS_FOR_FOLD

    def to_dict(self) -> dict[str, Any]:
        """Return the reason as JSON: the sentence as `message`, its code and numbers as `says`."""
        written: dict[str, Any] = _REASONS.write(self)
        return {**written, "message": self.message, "says": self.says.to_dict()}

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Reason":
        """Return the reason that JSON holds; raises `RequestError`."""
        fields = dict(data)
        says = dict(fields.pop("says", None) or {"code": ""})
        message = {"code": says.pop("code", ""), "text": fields.pop("message", None), "values": says}
        return _REASONS.read({**fields, "says": message})


_REASONS = JsonForm(Reason)
