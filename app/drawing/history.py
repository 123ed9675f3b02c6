"""The undo history of a drawing.

A history is an immutable value: taking a step, undoing and redoing return new ones. Undo followed by redo restores it.
"""

from dataclasses import dataclass

from app.drawing.drawing import Drawing

STEPS_MAX = 200
"""Largest number of steps kept for undo; older ones are dropped."""


@dataclass(frozen=True, slots=True)
class Step:
    """A step kept for undo or redo.

    Attributes:
        label: the step's label, in words.
        drawing: the drawing to return to.
    """

    label: str
    drawing: Drawing


@dataclass(frozen=True, slots=True)
class History:
    """The steps available for undo and redo.

    Attributes:
        past: the steps to undo, each with the drawing before it, the latest last.
        future: the steps to redo, each with the drawing after it, the next last.
    """

    past: tuple[Step, ...] = ()
    future: tuple[Step, ...] = ()

    @property
    def can_undo(self) -> str | None:
        """The label of the step that undo would take back, or None."""
        return self.past[-1].label if self.past else None

    @property
    def can_redo(self) -> str | None:
        """The label of the step that redo would restore, or None."""
        return self.future[-1].label if self.future else None

    def stepped(self, label: str, before: Drawing) -> "History":
        """Return the history after one more step, with nothing left to redo."""
        kept = before.sharing(self.past[-1].drawing) if self.past else before
        return History((*self.past, Step(label, kept))[-STEPS_MAX:])

    def undone(self, now: Drawing) -> tuple[Drawing, "History"]:
        """Return the drawing before the last step, and the history after undoing it; no change at the start."""
        if not self.past:
            return now, self
        *past, last = self.past
        return last.drawing, History(tuple(past), (*self.future, Step(last.label, now)))

    def redone(self, now: Drawing) -> tuple[Drawing, "History"]:
        """Return the drawing after the step undone last, and the history after redoing it; no change without one."""
        if not self.future:
            return now, self
        *future, following = self.future
        return following.drawing, History((*self.past, Step(following.label, now)), tuple(future))

    def forgotten(self) -> "History":
        """Return the history without its last step, which had no effect."""
        return History(self.past[:-1], self.future)
