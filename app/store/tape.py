"""A document's undo sequence: the drawings that undo goes back through, the current one, and those that redo restores.

A step appends a drawing; undo and redo only move along the sequence. So a change leaves nearly all of it in place and
adds little. A journal stores only these changes.
"""

from itertools import pairwise, takewhile
from typing import Generic, NamedTuple, TypeVar

from app.drawing.drawing import Drawing
from app.drawing.history import History, Step

D = TypeVar("D")

_DROPPED_MAX = 2
"""Largest number of steps in one change, and so of sheets dropped at the front."""


class Sheet(NamedTuple, Generic[D]):
    """A drawing of the sequence, and the label of the step that led to it; empty for the first."""

    label: str
    drawing: D


class TapeChange(NamedTuple, Generic[D]):
    """The change from one tape to another.

    The number of sheets dropped at the front, the number of the next ones kept, the sheets added behind them, and the
    new
    index.
    """

    dropped: int
    kept: int
    added: tuple[Sheet[D], ...]
    now: int


class Tape(NamedTuple, Generic[D]):
    """All sheets, and the index of the current one."""

    sheets: tuple[Sheet[D], ...]
    now: int

    def changed(self, change: TapeChange[D]) -> "Tape[D]":
        """Return the tape after a change; raise `ValueError` if the change does not fit this tape."""
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
        """Return the number of sheets after the dropped ones with which the other tape begins."""
        old, new = self.sheets[dropped:], after.sheets
        if not old or old[0].drawing != new[0].drawing:
            return 0
        return 1 + sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(old[1:], new[1:], strict=False)))


def whole(tape: Tape[D]) -> TapeChange[D]:
    """Return the change from an empty tape to this one."""
    return TapeChange(0, 0, tape.sheets, tape.now)


def tape_of(drawing: Drawing, history: History) -> Tape[Drawing]:
    """Return the tape of a drawing and its history."""
    steps = [*history.past, *reversed(history.future)]
    drawings = [*(step.drawing for step in history.past), drawing, *(step.drawing for step in reversed(history.future))]
    labels = ["", *(step.label for step in steps)]
    return Tape(tuple(map(Sheet, labels, drawings)), len(history.past))


def history_of(tape: Tape[Drawing]) -> tuple[Drawing, History]:
    """Return the drawing and the history of a tape."""
    sheets, now = tape
    past = tuple(Step(after.label, before.drawing) for before, after in pairwise(sheets[: now + 1]))
    future = tuple(Step(sheet.label, sheet.drawing) for sheet in reversed(sheets[now + 1 :]))
    return sheets[now].drawing, History(past, future)
