"""Steps, gestures and nudges."""

from copy import deepcopy
from dataclasses import replace
from itertools import pairwise

import pytest

from app.drawing.draft import Draft, draft_of
from app.drawing.drawing import Drawing
from app.drawing.edit import COALESCE_S, Edit, Phase
from app.drawing.history import STEPS_MAX
from tests.app.drawing.drawings import pulled, towel_drawing

TOWEL = towel_drawing(folds=[])


def moved(steps: int) -> Drawing:
    """Return the towel with its first corner moved left by some millimetres."""
    return pulled(deepcopy(TOWEL), 0, -0.001 * steps, 0.0)


def edited(draft: Draft, *edits: tuple[Phase, int], gesture: str | None = None) -> Draft:
    for phase, steps in edits:
        draft = draft.edited(Edit(f"to {steps}", moved(steps), phase, gesture=gesture), 0.0)
    return draft


def labels(draft: Draft) -> list[str]:
    return [step.label for step in draft.history.past]


def test_a_commit_is_one_named_step() -> None:
    draft = edited(draft_of(TOWEL), (Phase.COMMIT, 1))
    assert draft.drawing == moved(1)
    assert draft.history.can_undo == "to 1"
    assert draft.undone().drawing == TOWEL
    assert draft.undone().history.can_redo == "to 1"


def test_steps_share_all_that_stays_as_it_was() -> None:
    draft = edited(draft_of(TOWEL), *((Phase.COMMIT, steps) for steps in range(1, 5)))
    drawings = [step.drawing for step in draft.history.past]
    assert drawings == [TOWEL, moved(1), moved(2), moved(3)]
    for before, after in pairwise(drawings):
        assert before.outline[0] is not after.outline[0]
        assert all(one is other for one, other in zip(before.outline[1:], after.outline[1:], strict=True))
        assert before.scene is after.scene and before.placement is after.placement


def test_previews_make_no_step_and_the_commit_takes_them_all_back() -> None:
    draft = edited(draft_of(TOWEL), (Phase.PREVIEW, 1), (Phase.PREVIEW, 2), (Phase.COMMIT, 3))
    assert labels(draft) == ["to 3"]
    assert draft.undone().drawing == TOWEL


def test_a_cancelled_gesture_leaves_nothing() -> None:
    draft = edited(draft_of(TOWEL), (Phase.PREVIEW, 1), (Phase.PREVIEW, 2))
    assert draft.drawing == moved(2)
    cancelled = draft.edited(Edit("", None, Phase.CANCEL), 0.0)
    assert cancelled.drawing == TOWEL
    assert labels(cancelled) == []
    assert cancelled.gesture is None


def test_a_gesture_that_ends_where_it_began_leaves_no_step() -> None:
    draft = edited(draft_of(TOWEL), (Phase.PREVIEW, 1), (Phase.COMMIT, 0))
    assert labels(draft) == []
    assert draft.gesture is None


def test_what_changes_nothing_is_the_same_draft() -> None:
    draft = edited(draft_of(TOWEL), (Phase.COMMIT, 1))
    assert edited(draft, (Phase.COMMIT, 1)) is draft
    assert edited(draft, (Phase.PREVIEW, 1)) is draft
    assert draft.edited(Edit("", None, Phase.CANCEL), 0.0) is draft
    assert draft.redone() is draft
    assert draft_of(TOWEL).undone().drawing == TOWEL


def test_a_gesture_that_nobody_ended_is_a_step_when_the_next_begins() -> None:
    draft = edited(draft_of(TOWEL), (Phase.PREVIEW, 1), gesture="one")
    draft = edited(draft, (Phase.PREVIEW, 2), (Phase.COMMIT, 3), gesture="two")
    assert labels(draft) == ["to 1", "to 3"]
    assert draft.undone().drawing == moved(1)


def test_undo_takes_a_gesture_that_is_going_on_back_and_redo_gives_it_again() -> None:
    draft = edited(draft_of(TOWEL), (Phase.COMMIT, 1), (Phase.PREVIEW, 2))
    assert draft.undone().drawing == moved(1)
    assert draft.undone().redone().drawing == moved(2)


def test_a_new_step_forgets_what_was_undone() -> None:
    draft = edited(draft_of(TOWEL), (Phase.COMMIT, 1)).undone()
    assert edited(draft, (Phase.COMMIT, 2)).history.can_redo is None


def nudged(draft: Draft, *at_s: float, key: str = "arrows") -> Draft:
    for number, now_s in enumerate(at_s, start=1):
        draft = draft.edited(Edit("Nudge", moved(number), coalesce=key), now_s)
    return draft


def test_nudges_without_a_pause_are_one_step() -> None:
    draft = nudged(draft_of(TOWEL), 0.0, COALESCE_S, 2 * COALESCE_S)
    assert draft.drawing == moved(3)
    assert labels(draft) == ["Nudge"]
    assert draft.undone().drawing == TOWEL


def test_a_pause_begins_another_step() -> None:
    assert labels(nudged(draft_of(TOWEL), 0.0, COALESCE_S + 0.001)) == ["Nudge", "Nudge"]


def test_another_key_or_anything_between_begins_another_step() -> None:
    first = nudged(draft_of(TOWEL), 0.0)
    other = first.edited(Edit("Nudge", moved(5), coalesce="others"), 0.1)
    assert labels(other) == ["Nudge", "Nudge"]
    between = edited(first, (Phase.COMMIT, 7)).edited(Edit("Nudge", moved(8), coalesce="arrows"), 0.1)
    assert labels(between) == ["Nudge", "to 7", "Nudge"]
    undone = first.undone().edited(Edit("Nudge", moved(8), coalesce="arrows"), 0.1)
    assert labels(undone) == ["Nudge"]


def test_nudges_to_and_fro_leave_no_step() -> None:
    draft = nudged(draft_of(TOWEL), 0.0).edited(Edit("Nudge", TOWEL, coalesce="arrows"), 0.1)
    assert draft.drawing == TOWEL
    assert labels(draft) == []


def test_the_oldest_steps_are_forgotten() -> None:
    draft = draft_of(TOWEL)
    for number in range(STEPS_MAX + 5):
        draft = edited(draft, (Phase.COMMIT, number + 1))
    assert len(draft.history.past) == STEPS_MAX
    for _ in range(STEPS_MAX + 1):
        draft = draft.undone()
    assert draft.drawing == moved(5)


@pytest.mark.parametrize("count", [1, 3])
def test_undoing_and_redoing_everything_is_where_one_was(count: int) -> None:
    draft = edited(draft_of(TOWEL), *((Phase.COMMIT, i + 1) for i in range(count)))
    there = draft
    for _ in range(count):
        there = there.undone()
    for _ in range(count):
        there = there.redone()
    assert there.drawing == draft.drawing
    assert there.history == draft.history


def test_a_title_is_a_step_like_any_other() -> None:
    draft = draft_of(TOWEL).edited(Edit("Rename", replace(TOWEL, title="Napkin")), 0.0)
    assert draft.undone().drawing.title == "My towel"
