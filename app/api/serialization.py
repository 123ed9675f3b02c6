"""Serialization of messages to pages about a document: each is written as JSON once, for all of its pages."""

import json

from app.api.live_messages import document_message, plan_message, playback_message
from app.document import Document
from app.document_state import DocumentState
from app.open_document import OpenDocument
from app.visitors_view import VisitorsView


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
