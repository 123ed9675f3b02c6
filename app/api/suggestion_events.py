"""The events of a search for suggestions."""

from typing import Any, Literal

from pydantic import BaseModel

from app.api.answers import Change, Says
from app.api.event_streams import event_stream

Kind = Literal[
    "placement",
    "fold_line",
    "split",
    "halve",
    "flip",
    "order",
    "station",
    "robot",
    "size",
    "friction",
    "grip_radius",
    "comfort_radius",
    "together",
]


class TryingEvent(BaseModel):
    """The data of an event `trying`: a change that is being planned."""

    kind: Kind
    says: Says


class SuggestionEvent(BaseModel):
    """The data of an event `suggestion`: a change that gives a plan, and the plan's id."""

    kind: Kind
    is_assumption: bool
    message: str
    says: Says
    change: Change
    size: float
    cost_s: float
    plan_id: str


class DoneEvent(BaseModel):
    """The data of the last event, `done`: how many were found, how long it took, whether all changes were tried."""

    count: int
    elapsed_s: float
    complete: bool


EVENTS = (TryingEvent, SuggestionEvent, DoneEvent)

_SHIFTED: dict[str, Any] = {
    "kind": "placement",
    "says": {"code": "place", "quarters": 0, "by": [-0.1, 0.0]},
}
STREAM = event_stream(
    {
        "trying": (TryingEvent, _SHIFTED),
        "suggestion": (
            SuggestionEvent,
            {
                **_SHIFTED,
                "is_assumption": False,
                "message": "move it 10 cm",
                "change": {"placement": {"x_m": -0.5, "y_m": 0.2, "yaw_rad": 0.0}},
                "size": 0.1,
                "cost_s": 16.2,
                "plan_id": "0123456789abcdef0123456789abcdef",
            },
        ),
        "done": (DoneEvent, {"count": 1, "elapsed_s": 2.5, "complete": True}),
    },
    "Changes as they are tried and found",
)
