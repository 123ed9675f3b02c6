"""A drawing that is being worked on: what is drawn now, the steps that led there, the gesture that is going on.

A value with one method for each thing that can happen to it. One that changes nothing gives back the same draft.
"""

from dataclasses import dataclass, field

from app.drawing.drawing import Drawing
from app.drawing.edit import COALESCE_S, Edit, Gesture, Phase
from app.drawing.history import History
from app.drawing.solution import Solution
from app.drawing.solve import solve


@dataclass(frozen=True, slots=True)
class Run:
    """Commits that follow each other at once and are one step.

    Attributes:
        key: what they have in common.
        at_s: when the last of them came (s).
    """

    key: str
    at_s: float


@dataclass(frozen=True, slots=True)
class Draft:
    """A drawing and how it came about.

    Attributes:
        solution: the drawing, and what it comes to.
        history: what can be undone and redone.
        gesture: the gesture that is going on.
        run: the run of commits that the last step may go on.
    """

    solution: Solution
    history: History = field(default_factory=History)
    gesture: Gesture | None = None
    run: Run | None = None

    @property
    def drawing(self) -> Drawing:
        """What is drawn."""
        return self.solution.drawing

    def edited(self, edit: Edit, now_s: float) -> "Draft":
        """After a change that came at a time of the wall clock (s)."""
        if edit.phase is Phase.CANCEL or edit.drawing is None:
            return self._cancelled()
        is_another = self.gesture is not None and self.gesture.key != edit.gesture
        here = self.closed() if is_another else self
        if edit.phase is Phase.PREVIEW:
            return here._previewed(edit.label, edit.gesture, edit.drawing)
        return here._committed(edit, edit.drawing, now_s)

    def undone(self) -> "Draft":
        """The last step taken back; a gesture that is going on is a step."""
        here = self.closed()
        drawing, history = here.history.undone(here.drawing)
        return here if history is here.history else Draft(solve(drawing), history)

    def redone(self) -> "Draft":
        """The step taken again that was undone last."""
        here = self.closed()
        drawing, history = here.history.redone(here.drawing)
        return here if history is here.history else Draft(solve(drawing), history)

    def closed(self) -> "Draft":
        """The gesture that is going on made a step, as it is."""
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
        run = Run(edit.coalesce, now_s) if edit.coalesce else None
        if run is not None and self._goes_on(run):
            last = self.history.past[-1]
            history = self.history.forgotten() if last.drawing == solution.drawing else self.history
            return Draft(solution, history, run=run if history is self.history else None)
        return Draft(solution, self.history.stepped(edit.label, before), run=run)

    def _goes_on(self, run: Run) -> bool:
        return self.run is not None and self.run.key == run.key and run.at_s - self.run.at_s <= COALESCE_S


def draft_of(drawing: Drawing) -> Draft:
    """A drawing that nobody has worked on yet."""
    return Draft(solve(drawing))
