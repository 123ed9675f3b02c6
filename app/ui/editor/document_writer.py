"""Writes into the document on behalf of one visitor of a 3D view.

A change is a function of the document's state, not a drawing: when another visitor was faster, it is applied again, to
the new state.
"""

import itertools
from collections.abc import Callable
from typing import TypeAlias

from app.document import Document
from app.document_state import DocumentState
from app.drawing.drawing import Drawing
from app.drawing.edit import Edit, Phase, StaleVersionError

Change: TypeAlias = Callable[[DocumentState], Drawing]
"""A function from the document's state to the new drawing; it raises `FoldingError` for what cannot be done."""


class DocumentWriter:
    """Commits, and gestures, each of which becomes one step."""

    def __init__(self, document: Document, owner: str) -> None:
        """Begin without a gesture.

        Args:
            document: the document that is changed.
            owner: a name that no other writer has.
        """
        self._document = document
        self._owner = owner
        self._numbers = itertools.count()
        self._gesture: str | None = None

    @property
    def state(self) -> DocumentState:
        """The document's state now."""
        return self._document.state

    def preview(self, label: str, change: Change) -> DocumentState:
        """Show a change as part of a gesture; the first one begins it."""
        if self._gesture is None:
            self._gesture = f"{self._owner}.{next(self._numbers)}"
        return self._write(label, change, Phase.PREVIEW)

    def commit(self, label: str, change: Change) -> DocumentState:
        """Commit a change as one step, together with the previews before it."""
        state = self._write(label, change, Phase.COMMIT)
        self._gesture = None
        return state

    def cancel(self) -> None:
        """Take the previews back, unless another visitor's step has included them meanwhile."""
        key, self._gesture = self._gesture, None
        going_on = self._document.state.draft.gesture
        if key is not None and going_on is not None and going_on.key == key:
            self._document.edit(Edit("", None, Phase.CANCEL, gesture=key))

    def _write(self, label: str, change: Change, phase: Phase) -> DocumentState:
        try:
            return self._write_once(label, change, phase)
        except StaleVersionError:
            return self._write_once(label, change, phase)

    def _write_once(self, label: str, change: Change, phase: Phase) -> DocumentState:
        state = self._document.state
        edit = Edit(label, change(state), phase, base_version=state.version, gesture=self._gesture)
        return self._document.edit(edit)
