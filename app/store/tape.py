"""A document's drawings in a row: what undo goes back through, what is drawn, what redo goes forward through.

A step appends a drawing, undo and redo only move along the row. So from one change to the next nearly all of the row
stays, and what a change adds to it is small: that is what a journal keeps.
"""

from itertools import pairwise, takewhile
from typing import Generic, NamedTuple, TypeVar

from app.drawing.drawing import Drawing
from app.drawing.history import History, Step

D = TypeVar("D")

_DROPPED_MAX = 2
"""Steps that one change makes at most, and so sheets that it may push out at the front."""


class Sheet(NamedTuple, Generic[D]):
    """One drawing of the row, and what was done to the one before; of the first it says nothing."""

    label: str
    drawing: D


class TapeChange(NamedTuple, Generic[D]):
    """How a tape becomes another: so many sheets dropped at the front, the next ones kept, others added behind them."""

    dropped: int
    kept: int
    added: tuple[Sheet[D], ...]
    now: int


class Tape(NamedTuple, Generic[D]):
    """All sheets, and the index of the one that is drawn now."""

    sheets: tuple[Sheet[D], ...]
    now: int

    def changed(self, change: TapeChange[D]) -> "Tape[D]":
        """Return the tape after a change; raises `ValueError` for a change of another tape."""
        dropped, kept, added, now = change
        sheets = (*self.sheets[dropped : dropped + kept], *added)
        if len(sheets) != kept + len(added) or not 0 <= now < len(sheets):
            raise ValueError("it does not continue what stands before it")
        return Tape((Sheet("", sheets[0].drawing), *sheets[1:]), now)

    def change_to(self, after: "Tape[D]") -> TapeChange[D]:
        """Return the smallest change that leads to another tape."""
        dropped = max(range(_DROPPED_MAX + 1), key=lambda count: self._kept(after, count))
        kept = self._kept(after, dropped)
        return TapeChange(dropped, kept, after.sheets[kept:], after.now)

    def _kept(self, after: "Tape[D]", dropped: int) -> int:
        """How many sheets after the dropped ones begin another tape, too."""
        old, new = self.sheets[dropped:], after.sheets
        if not old or old[0].drawing != new[0].drawing:
            return 0
        return 1 + sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(old[1:], new[1:], strict=False)))


def whole(tape: Tape[D]) -> TapeChange[D]:
    """Return the change that makes a tape out of nothing."""
    return TapeChange(0, 0, tape.sheets, tape.now)


def tape_of(drawing: Drawing, history: History) -> Tape[Drawing]:
    """Return what is drawn, between what can be undone and what can be redone."""
    steps = [*history.past, *reversed(history.future)]
    drawings = [*(step.drawing for step in history.past), drawing, *(step.drawing for step in reversed(history.future))]
    labels = ["", *(step.label for step in steps)]
    return Tape(tuple(map(Sheet, labels, drawings)), len(history.past))


def history_of(tape: Tape[Drawing]) -> tuple[Drawing, History]:
    """Return the drawing and the history that a tape was made of."""
    sheets, now = tape
    past = tuple(Step(after.label, before.drawing) for before, after in pairwise(sheets[: now + 1]))
    future = tuple(Step(sheet.label, sheet.drawing) for sheet in reversed(sheets[now + 1 :]))
    return sheets[now].drawing, History(past, future)
