"""Where a stack is expected before it is looked for, and the result of fitting its outline to one that was seen."""

import math
from dataclasses import asdict, dataclass, replace
from typing import Any

from planner.geometry.pose import Pose2
from planner.message import Message


@dataclass(frozen=True, slots=True)
class Expected:
    """A placement and how sure it is: standard deviations each way and of the angle.

    Attributes:
        placement: the garment frame in the table frame.
        within_m: of its place (m). Laid down by hand, or dragged, cloth is within some centimetres of where it ought to
            be.
        within_rad: of its angle (rad).
    """

    placement: Pose2
    within_m: float = 0.03
    within_rad: float = 0.08

    def loosened(self, by_m: float, by_rad: float) -> "Expected":
        """Return the same after something may have moved it by so much more (standard deviations)."""
        return replace(self, within_m=math.hypot(self.within_m, by_m), within_rad=math.hypot(self.within_rad, by_rad))


LOOKS_ALIKE = "looks_alike"
"""The code of the message that several placements fit equally well."""

TOO_UNCERTAIN = "too_uncertain"
"""The code of the message that the outline fits but leaves the placement too uncertain."""


@dataclass(frozen=True, slots=True)
class StackFit:
    """A stack's placement, and how sure it is.

    Attributes:
        placement: the garment frame in the table frame; the best there is, also where `unknown` says it may be wrong.
        error_m: how far off the corners of the stack may be: about 95 of 100 are nearer than that to where they are
            said to be (m).
        residual_m: the median distance of the points seen from the fitted outline (m).
        share_on_outline: the share of the points seen that lie within 1 cm of it.
        share_seen: the share of the outline that has a point seen within 1 cm.
        overlap: the area inside both the outline seen and the fitted one, as a share of what either encloses; what is
            hidden counts as what is seen. Of a stack that was just folded the last crease, and how far creases lie
            inside of their lines, count as they were fitted.
        others: further placements that fit as well, for a figure that is nearly symmetric.
        unknown: why the placement is not known; None where it is.
    """

    placement: Pose2
    error_m: float
    residual_m: float
    share_on_outline: float
    share_seen: float
    overlap: float
    others: tuple[Pose2, ...] = ()
    unknown: Message | None = None

    @property
    def is_known(self) -> bool:
        """Whether the placement can be relied on."""
        return self.unknown is None

    def to_dict(self) -> dict[str, Any]:
        """Return the fit as JSON."""
        fit = asdict(self)
        del fit["unknown"]
        return {**fit, "others": [*fit["others"]], **unknown_json(self.unknown)}


@dataclass(frozen=True, slots=True)
class FoldFit:
    """A stack after a fold, with how far the fold is from where it should be.

    Attributes:
        stack: where the stack lies.
        offset_m: how far the crease is to the left of its line, at the middle of it (m): the part that moved is smaller
            then.
        turn_rad: how far it is turned, counter-clockwise (rad).
        off_m: how far the corners of the part that moved are from where they should be, at most (m).
        offset_error_m: how far off `offset_m` may be, at about 95 of 100 (m).
        turn_error_rad: the same of `turn_rad` (rad).
    """

    stack: StackFit
    offset_m: float
    turn_rad: float
    off_m: float
    offset_error_m: float
    turn_error_rad: float

    def to_dict(self) -> dict[str, Any]:
        """Return the fit as JSON."""
        return {
            **self.stack.to_dict(),
            "crease_offset_m": self.offset_m,
            "crease_offset_error_m": self.offset_error_m,
            "crease_turn_rad": self.turn_rad,
            "crease_turn_error_rad": self.turn_error_rad,
            "off_m": self.off_m,
        }


def unknown_json(unknown: Message | None) -> dict[str, Any]:
    """Return whether something is known, and why not, as JSON."""
    if unknown is None:
        return {"known": True, "reason": None, "says": None}
    return {"known": False, "reason": unknown.text, "says": unknown.to_dict()}
