"""A draft: a drawing under edit, with its undo history and the gesture in progress.

A draft is an immutable value with one method for each event. An event that changes nothing returns the same draft.
"""

from dataclasses import dataclass, field

from app.drawing.drawing import Drawing
from app.drawing.edit import COALESCE_S, Edit, Gesture, Phase
from app.drawing.history import History
from app.drawing.solution import Solution
from app.drawing.solve import solve


@dataclass(frozen=True, slots=True)
class Coalescing:
    """A series of commits in quick succession that count as one undo step.

    Attributes:
        key: the key that the commits share.
        at_s: the time of the latest commit (s).
    """

    key: str
    at_s: float


@dataclass(frozen=True, slots=True)
class Draft:
    """A drawing under edit.

    Attributes:
        solution: the drawing, solved.
        history: the undo and redo steps.
        gesture: the gesture in progress, if any.
        coalescing: the series of commits that the next commit may join.
    """

    solution: Solution
    history: History = field(default_factory=History)
    gesture: Gesture | None = None
    coalescing: Coalescing | None = None

    @property
    def drawing(self) -> Drawing:
        """The current drawing."""
        return self.solution.drawing

    def edited(self, edit: Edit, now_s: float) -> "Draft":
        """Return the draft after an edit that arrived at a wall-clock time (s)."""
        if edit.phase is Phase.CANCEL or edit.drawing is None:
            return self._cancelled()
        is_another = self.gesture is not None and self.gesture.key != edit.gesture
        here = self.closed() if is_another else self
        if edit.phase is Phase.PREVIEW:
            return here._previewed(edit.label, edit.gesture, edit.drawing)
        return here._committed(edit, edit.drawing, now_s)

    def undone(self) -> "Draft":
        """Return the draft with the last step undone; a gesture in progress counts as a step."""
        here = self.closed()
        drawing, history = here.history.undone(here.drawing)
        return here if history is here.history else Draft(solve(drawing), history)

    def redone(self) -> "Draft":
        """Return the draft with the last undone step redone."""
        here = self.closed()
        drawing, history = here.history.redone(here.drawing)
        return here if history is here.history else Draft(solve(drawing), history)

    def closed(self) -> "Draft":
        """Return the draft with the gesture in progress turned into a step."""
        if self.gesture is None:
            return self
        if self.gesture.before == self.drawing:
            return Draft(self.solution, self.history)
        return Draft(self.solution, self.history.stepped(self.gesture.label, self.gesture.before))

    def _cancelled(self) -> "Draft":
        return self if self.gesture is None else Draft(solve(self.gesture.before), self.history)

    def _previewed(self, label: str, key: str | None, drawing: Drawing) -> "Draft":
        solution = solve(drawing)
        if solution.drawing == self.drawing:
            return self
        gesture = self.gesture or Gesture(key, label, self.drawing)
        return Draft(solution, self.history, gesture)

    def _committed(self, edit: Edit, drawing: Drawing, now_s: float) -> "Draft":
        solution = solve(drawing)
        before = self.gesture.before if self.gesture else self.drawing
        if solution.drawing == before:
            return self if self.gesture is None else Draft(solution, self.history)
        commit = Coalescing(edit.coalesce, now_s) if edit.coalesce else None
        if commit is not None and self._goes_on(commit):
            last = self.history.past[-1]
            history = self.history.forgotten() if last.drawing == solution.drawing else self.history
            return Draft(solution, history, coalescing=commit if history is self.history else None)
        return Draft(solution, self.history.stepped(edit.label, before), coalescing=commit)

    def _goes_on(self, commit: Coalescing) -> bool:
        before = self.coalescing
        return before is not None and before.key == commit.key and commit.at_s - before.at_s <= COALESCE_S


def draft_of(drawing: Drawing) -> Draft:
    """Return a draft of a drawing without history."""
    return Draft(solve(drawing))
