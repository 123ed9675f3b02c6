"""The tape of a document's drawings: no history is lost, and each change is as small as the edit."""

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.drawing.drawing import Drawing
from app.drawing.edit import Edit
from app.drawing.history import STEPS_MAX
from app.store.tape import Tape, TapeChange, history_of, tape_of, whole
from tests.app.store.drafts import TOWEL, moved, worked_on


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000))
def test_a_tape_gives_back_the_history_it_was_made_of(seed: int) -> None:
    for draft in worked_on(seed, 12):
        drawing, history = history_of(tape_of(draft.drawing, draft.history))
        assert (drawing, history) == (draft.drawing, draft.history)


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000), skipped=st.integers(1, 3))
def test_changes_lead_from_tape_to_tape(seed: int, skipped: int) -> None:
    tapes = [tape_of(draft.drawing, draft.history) for draft in worked_on(seed, 16)][::skipped]
    empty: Tape[Drawing] = Tape((), 0)
    replayed = empty.changed(whole(tapes[0]))
    for before, after in pairwise(tapes):
        replayed = replayed.changed(before.change_to(after))
        assert replayed == after


def test_a_step_adds_one_drawing_and_going_back_and_forth_adds_none() -> None:
    draft, added = TOWEL, []
    for number in range(STEPS_MAX + 5):
        before, draft = draft, draft.edited(Edit("Move", moved(1 + number % 2)), 10.0 * number)
        change = tape_of(before.drawing, before.history).change_to(tape_of(draft.drawing, draft.history))
        added.append(len(change.added))
    assert set(added) == {1}
    for after in (draft.undone(), draft.undone().undone(), draft.undone().redone()):
        change = tape_of(draft.drawing, draft.history).change_to(tape_of(after.drawing, after.history))
        assert change.added == ()


@pytest.mark.parametrize(
    "change", [TapeChange(0, 2, (), 0), TapeChange(1, 1, (), 0), TapeChange(0, 1, (), 1), TapeChange(0, 0, (), 0)]
)
def test_a_change_of_another_tape_is_refused(change: TapeChange[Drawing]) -> None:
    with pytest.raises(ValueError, match="does not continue"):
        tape_of(TOWEL.drawing, TOWEL.history).changed(change)
