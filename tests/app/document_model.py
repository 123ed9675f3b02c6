"""What a document's history should hold, by a model that knows nothing of how it is done.

A list of drawings that can be gone back to, one of drawings that can be gone forward to, and perhaps a gesture that is
going on. Drawings are as the server tells them.
"""

from typing import Any

Drawing = dict[str, Any]


class DocumentModel:
    """The history of one document, each step with its name and the drawing on its other side."""

    def __init__(self) -> None:
        self.past: list[tuple[str, Drawing]] = []
        self.future: list[tuple[str, Drawing]] = []
        self.gesture: tuple[str, str, Drawing] | None = None
        """Its key, its label and the drawing before it."""

    @property
    def history(self) -> dict[str, str | None]:
        return {
            "can_undo": self.past[-1][0] if self.past else None,
            "can_redo": self.future[-1][0] if self.future else None,
        }

    def edit(self, phase: str, label: str, key: str, now: Drawing, after: Drawing) -> None:
        """A drawing has become another, by a gesture's preview or its commit."""
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
        """A step, unless nothing has changed."""
        if after != before:
            self.past.append((label, before))
            self.future = []

    def close_gesture(self, now: Drawing) -> None:
        """What goes on becomes a step of its own."""
        if self.gesture is not None:
            _, label, before = self.gesture
            self.gesture = None
            self.step(label, before, now)

    def drop_gesture(self, now: Drawing) -> Drawing:
        """The drawing without what was going on."""
        before = self.gesture[2] if self.gesture else now
        self.gesture = None
        return before

    def undo(self, now: Drawing) -> Drawing:
        """The drawing a step further back."""
        self.close_gesture(now)
        return _go(self.past, self.future, now)

    def redo(self, now: Drawing) -> Drawing:
        """The drawing a step further on."""
        self.close_gesture(now)
        return _go(self.future, self.past, now)


def _go(here: list[tuple[str, Drawing]], there: list[tuple[str, Drawing]], now: Drawing) -> Drawing:
    if not here:
        return now
    label, target = here.pop()
    there.append((label, now))
    return target
