"""What the page is told about a document."""

from typing import Any

from app.document import DocumentState
from planner.errors import FoldingError


def document_message(name: str, state: DocumentState) -> dict[str, Any]:
    """Garment, plan and status."""
    plan = None if state.plan is None else {"id": state.plan_id, **state.plan.to_dict()}
    return {
        "kind": "document",
        "name": name,
        "version": state.version,
        "garment": state.garment.to_dict(),
        "status": status_word(state),
        "text": status_text(state),
        "plan": plan,
    }


def playback_message(state: DocumentState, t_s: float) -> dict[str, Any]:
    """The clock."""
    playback = state.playback
    return {
        "kind": "playback",
        "version": state.version,
        "t_s": t_s,
        "duration_s": playback.duration_s,
        "playing": playback.is_playing,
        "speed": playback.speed,
    }


def problem_message(error: FoldingError) -> dict[str, Any]:
    """A command that could not be obeyed."""
    return {"kind": "problem", "detail": str(error)}


def status_word(state: DocumentState) -> str:
    """``planning``, ``failed``, or the plan's own status."""
    if state.problem is not None:
        return "failed"
    return "planning" if state.plan is None else state.plan.status


def status_text(state: DocumentState) -> str:
    """The status as a person reads it."""
    if state.problem is not None:
        return f"No plan: {state.problem}"
    plan = state.plan
    if plan is None:
        return "Planning..."
    if plan.status == "solved":
        count = len(plan.primitives)
        return f"Planned: {count} primitive{'' if count == 1 else 's'}, {plan.cost_s:.1f} s"
    if plan.status == "budget_exceeded":
        return "No plan: the time for searching ran out"
    first = next((reason.message for reason in plan.reasons if reason.message), None)
    return f"No plan: {first}" if first else "No plan"
