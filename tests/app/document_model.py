"""A model of a document's history, independent of the implementation.

It has a list of drawings to undo to, one of drawings to redo to, and possibly a gesture in progress. Drawings are in
the server's JSON form.
"""

from typing import Any

Drawing = dict[str, Any]


class DocumentModel:
    """The history of one document, each step with its name and the drawing on its other side."""

    def __init__(self) -> None:
        self.past: list[tuple[str, Drawing]] = []
        self.future: list[tuple[str, Drawing]] = []
        self.gesture: tuple[str, str, Drawing] | None = None
        """The key and the label of the gesture in progress, and the drawing before it."""

    @property
    def history(self) -> dict[str, str | None]:
        return {
            "can_undo": self.past[-1][0] if self.past else None,
            "can_redo": self.future[-1][0] if self.future else None,
        }

    def edit(self, phase: str, label: str, key: str, now: Drawing, after: Drawing) -> None:
        """Replace the drawing by a gesture's preview or its commit."""
        if self.gesture is not None and self.gesture[0] != key:
            self.close_gesture(now)
        before = self.gesture[2] if self.gesture else now
        if phase == "preview":
            if after != now and self.gesture is None:
                self.gesture = (key, label, before)
        else:
            self.gesture = None
            self.step(label, before, after)

    def step(self, label: str, before: Drawing, after: Drawing) -> None:
        """Add a step, unless nothing has changed."""
        if after != before:
            self.past.append((label, before))
            self.future = []

    def close_gesture(self, now: Drawing) -> None:
        """Commit the gesture in progress as a step of its own."""
        if self.gesture is not None:
            _, label, before = self.gesture
            self.gesture = None
            self.step(label, before, now)

    def drop_gesture(self, now: Drawing) -> Drawing:
        """Return to the drawing before the gesture in progress."""
        before = self.gesture[2] if self.gesture else now
        self.gesture = None
        return before

    def undo(self, now: Drawing) -> Drawing:
        """Return to the drawing one step back."""
        self.close_gesture(now)
        return _go(self.past, self.future, now)

    def redo(self, now: Drawing) -> Drawing:
        """Return to the drawing one step forward."""
        self.close_gesture(now)
        return _go(self.future, self.past, now)


def _go(here: list[tuple[str, Drawing]], there: list[tuple[str, Drawing]], now: Drawing) -> Drawing:
    if not here:
        return now
    label, target = here.pop()
    there.append((label, now))
    return target
