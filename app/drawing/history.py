"""What was drawn before, step by step: undo and redo.

A value: taking a step, undoing and redoing give new ones. Undo then redo gives back what was there.
"""

from dataclasses import dataclass

from app.drawing.drawing import Drawing

STEPS_MAX = 200
"""So many steps can be undone; older ones are forgotten."""


@dataclass(frozen=True, slots=True)
class Step:
    """One step, as it is kept to be undone or redone.

    Attributes:
        label: what was done, in words.
        drawing: the drawing to go back to, or forward.
    """

    label: str
    drawing: Drawing


@dataclass(frozen=True, slots=True)
class History:
    """The steps that can be undone and redone.

    Attributes:
        past: each with the drawing before it, the latest last.
        future: each with the drawing after it, the next to be redone last.
    """

    past: tuple[Step, ...] = ()
    future: tuple[Step, ...] = ()

    @property
    def can_undo(self) -> str | None:
        """The label of the step that undo would take back."""
        return self.past[-1].label if self.past else None

    @property
    def can_redo(self) -> str | None:
        """The label of the step that redo would take again."""
        return self.future[-1].label if self.future else None

    def stepped(self, label: str, before: Drawing) -> "History":
        """One step further; what could be redone is gone."""
        return History((*self.past, Step(label, before))[-STEPS_MAX:])

    def undone(self, now: Drawing) -> tuple[Drawing, "History"]:
        """The drawing before the last step, and the history with that step to be redone; at the start, no change."""
        if not self.past:
            return now, self
        *past, last = self.past
        return last.drawing, History(tuple(past), (*self.future, Step(last.label, now)))

    def redone(self, now: Drawing) -> tuple[Drawing, "History"]:
        """The drawing after the step undone last, and the history with it to be undone; if there is none, no change."""
        if not self.future:
            return now, self
        *future, following = self.future
        return following.drawing, History((*self.past, Step(following.label, now)), tuple(future))

    def forgotten(self) -> "History":
        """Without the last step, which came to nothing."""
        return History(self.past[:-1], self.future)
