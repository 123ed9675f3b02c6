"""The three messages that tell pages about a document; each is written once for all of its pages."""

import json
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

from app.document import Document
from app.document_state import DocumentState, VersionPlan, shown_robot
from app.drawing.drawing_json import drawing_to_dict
from app.drawing.garment_drawing import garment_to_dict
from app.held_folds import FoldChecks
from app.open_document import OpenDocument
from app.visitors_view import VisitorsView
from planner.geometry.pose import Point2
from planner.robots.load_robot import robot_card_file
from planner.robots.varied_card import split_changes
from planner.task.plan import Statistics


def document_text(opened: OpenDocument, state: DocumentState) -> str:
    """Return the message about a state's drawing."""
    key = (state.version, state.draft)
    return opened.texts.text("document", key, lambda: json.dumps(document_message(opened.id, state)))


def plan_text(opened: OpenDocument, state: DocumentState) -> str:
    """Return the message about a state's plan."""
    return opened.texts.text("plan", _plan_key(state), lambda: json.dumps(plan_message(state)))


class SentState:
    """The state that one page has been sent."""

    def __init__(self, opened: OpenDocument, played: Document | VisitorsView) -> None:
        """Begin with nothing sent; `played` is the document, or the view of it that the page is of."""
        self._opened = opened
        self._played = played
        self._document: object = None
        self._plan: object = None
        self._playback: object = None

    def updates(self, state: DocumentState) -> list[str]:
        """Return the messages that bring the page up to date, as JSON."""
        messages = []
        document = (state.version, state.draft)
        if document != self._document:
            messages.append(document_text(self._opened, state))
        plan = _plan_key(state)
        if plan != self._plan:
            messages.append(plan_text(self._opened, state))
        playback = (state.playback, state.shown)
        if playback != self._playback or state.playback.is_playing:
            messages.append(json.dumps(playback_message(state, self._played.t_s)))
        self._document, self._plan, self._playback = document, plan, playback
        return messages


def _plan_key(state: DocumentState) -> object:
    """Return what the message about a state's plan is made of."""
    answers = (state.answer, state.before, state.checks, state.failure)
    return (state.version, *answers, state.start, state.prepared, state.is_compiling, state.is_thorough)


def document_message(document_id: str, state: DocumentState) -> dict[str, Any]:
    """Return the drawing, its solution, its problems and its history."""
    robot = state.drawing.robot
    card = robot_card_file(shown_robot(robot).name)
    solution, history, gesture = state.solution, state.draft.history, state.draft.gesture
    return {
        "kind": "document",
        "id": document_id,
        "version": state.version,
        "robot": {
            "name": robot,
            "title": card.title if card.name == split_changes(robot)[0] else robot,
            "arms": [arm.name for arm in card.arms],
            "base": card.base.kind,
            "mounts": [[mount.x_m, mount.y_m] for mount in card.mounts],
        },
        "drawing": drawing_to_dict(state.drawing),
        "garment": garment_to_dict(state.drawing),
        "solved": solution.fold_states(),
        "steps": solution.steps,
        "problems": [problem.to_dict() for problem in solution.problems],
        "history": {"can_undo": history.can_undo, "can_redo": history.can_redo},
        "gesture": None if gesture is None else gesture.label,
    }


def plan_message(state: DocumentState) -> dict[str, Any]:
    """Return the answer to the drawing; while it is being planned, the previous one."""
    is_shown = state.answer is not None and not state.solution.problems
    return {
        "kind": "plan",
        "version": state.version,
        "status": status_word(state),
        "text": status_text(state),
        "plan": _answer(state, state.answer) if is_shown and state.answer is not None else None,
        "prepared": state.prepared,
        "is_compiling": state.is_compiling,
        "may_look_longer": state.may_look_longer,
        "start": None if state.start is None else state.start.to_dict(),
        "before": None if state.before is None else _figures(state.before),
        "checks": None if state.checks is None else _checks(state.checks, _planned_grips(state)),
    }


def playback_message(state: DocumentState, t_s: float) -> dict[str, Any]:
    """Return the clock, and the version whose plan is played."""
    playback = state.playback
    return {
        "kind": "playback",
        "version": None if state.shown is None else state.shown.version,
        "t_s": t_s,
        "duration_s": playback.duration_s,
        "playing": playback.is_playing,
        "speed": playback.speed,
    }


def status_word(state: DocumentState) -> str:
    """Return ``illegal``, ``failed``, ``planning``, or the plan's own status."""
    if state.solution.problems:
        return "illegal"
    if state.failure is not None:
        return "failed"
    return state.answer.plan.status if state.answer is not None and state.is_answered else "planning"


def status_text(state: DocumentState) -> str:
    """Return the status as a sentence."""
    if state.solution.problems:
        return f"No plan: {state.solution.problems[0].text}"
    if state.failure is not None:
        return f"No plan: {state.failure}"
    if state.answer is None or not state.is_answered:
        return "Planning..."
    plan = state.answer.plan
    if plan.status == "solved":
        if not plan.garment.folds:
            return "No folds yet: draw the first one"
        count = len(plan.primitives)
        return f"Planned: {count} step{'' if count == 1 else 's'}, {plan.cost_s:.1f} s"
    if plan.status == "budget_exceeded":
        return f"No plan: {_out_of_time(plan.statistics)}"
    first = next((reason.message for reason in plan.reasons if reason.message), None)
    return f"No plan: {first}" if first else "No plan"


def _out_of_time(statistics: Statistics) -> str:
    """Return a sentence on how far a search came, and what would take it further."""
    ways, bound_s = statistics.ways, statistics.bound_s
    known = "" if bound_s is None else f"; any plan takes at least {bound_s:.1f} s"
    return (
        f"searched {ways:,} way{'' if ways == 1 else 's'} and found none{known}. "
        "To look longer may help, or fewer folds that may be done in any order"
    )


def _answer(state: DocumentState, answer: VersionPlan) -> dict[str, Any]:
    return {
        "version": answer.version,
        "is_stale": answer.version != state.version,
        "is_final": answer.is_final,
        "at_least_s": None if answer.plan.is_proven else answer.plan.statistics.bound_s,
        "id": answer.plan_id,
        **answer.body,
    }


def _figures(answer: VersionPlan) -> dict[str, Any]:
    return {"version": answer.version, "status": answer.plan.status, "cost_s": answer.plan.cost_s}


def _planned_grips(state: DocumentState) -> dict[int, tuple[Point2, ...]]:
    """Return the grips of each fold that the plan of this version makes, garment frame as it lies before the fold."""
    if state.answer is None or not state.is_answered:
        return {}
    steps = state.answer.plan.steps
    return {step.fold: tuple(one.point for one in step.holdings) for step in steps if step.fold is not None}


def _checks(checks: FoldChecks, planned: Mapping[int, tuple[Point2, ...]]) -> dict[str, Any]:
    """Return what each fold needs; grips as the plan has them, where it makes the fold, else the fewest that do."""
    folds = (replace(fold, grips=planned.get(number) or fold.grips) for number, fold in enumerate(checks.folds))
    return asdict(replace(checks, folds=tuple(folds)))
