"""Describes a step of a plan in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from planner.cloth.garment import Garment
    from planner.task.plan_step import PlanStep


def step_words(step: PlanStep, garment: Garment) -> str:
    """Return a few words on what a step does; empty for a kind without words."""
    details = step.details
    match step.kind:
        case "fold":
            return garment.folds[int(details["fold"])].name
        case "drag":
            return f"{details['distance_m']:.2f} m towards the robot" + (", holds on" if details["holds"] else "")
        case "arm_drag":
            return f"{details['distance_m']:.2f} m by the arms"
        case "move":
            return f"{details['from'] or 'elsewhere'} to {details['to'] or 'elsewhere'}"
    return ""
