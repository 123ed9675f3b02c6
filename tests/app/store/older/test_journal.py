"""A journal cut off anywhere restores every complete line; one that is damaged inside reports it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.drawing.edit import Edit
from app.store.older.journal import read_journal
from app.store.tape import Tape, tape_of, whole
from tests.app.store.drafts import TOWEL, moved, worked_on
from tests.app.store.older.journals import change_line, start_line


def written(seed: int, count: int) -> tuple[list[bytes], list[Tape]]:
    """Return a journal's lines, and the tape after each but the first."""
    tapes = [tape_of(draft.drawing, draft.history) for draft in worked_on(seed, count)]
    lines = [start_line("abcdefgh", 0), change_line(1, "then", whole(tapes[0]))]
    for number, after in enumerate(tapes[1:]):
        lines.append(change_line(number + 2, "then", tapes[number].change_to(after)))
    return lines, tapes


@settings(max_examples=60)
@given(seed=st.integers(0, 1000), data=st.data())
def test_what_was_cut_off_is_left_out_and_nothing_else(seed: int, data: st.DataObject) -> None:
    lines, tapes = written(seed, 6)
    content = b"".join(lines)
    shortest = len(lines[0]) + len(lines[1])
    left = data.draw(st.integers(shortest, len(content)))
    journal = read_journal(content[:left])
    complete = sum(1 for end in range(2, len(lines) + 1) if len(b"".join(lines[:end])) <= left)
    assert journal.tape() == tapes[complete - 1]
    assert journal.version == complete
    assert journal.whole_bytes == len(b"".join(lines[: complete + 1]))


@pytest.mark.parametrize("line", [1, 2, 3])
def test_a_damaged_line_that_others_follow_is_named(line: int) -> None:
    lines, _ = written(1, 5)
    lines[line] = lines[line].replace(b"towel", b"tower", 1).replace(b'"now":', b'"not":')
    with pytest.raises(ValueError, match=f"line {line + 1} is damaged"):
        read_journal(b"".join(lines))


@pytest.mark.parametrize("left", [0, 10])
def test_a_journal_without_a_drawing_is_none(left: int) -> None:
    lines, _ = written(1, 1)
    with pytest.raises(ValueError, match="ends before the first drawing"):
        read_journal(lines[0] + lines[1][:left])


def test_a_line_that_does_not_continue_the_one_before_is_named() -> None:
    one = TOWEL.edited(Edit("one", moved(1)), 0.0)
    two = one.edited(Edit("two", moved(2)), 10.0)
    first, second, third = (tape_of(draft.drawing, draft.history) for draft in (TOWEL, one, two))
    lines = [start_line("abcdefgh", 0), change_line(1, "then", whole(first))]
    lines.append(change_line(3, "then", second.change_to(third)))
    with pytest.raises(ValueError, match="line 3: it does not continue"):
        read_journal(b"".join(lines))
