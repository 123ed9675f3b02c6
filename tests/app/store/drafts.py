"""Drafts to be stored."""

import random
from collections.abc import Callable, Iterator

from app.drawing.draft import Draft, draft_of
from app.drawing.drawing import Drawing
from app.drawing.edit import Edit, Phase
from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from planner.cloth.garment import Garment
from tests.app.drawing.drawings import pulled
from tests.app.samples import towel

TOWEL = draft_of(drawing_of(Garment.from_dict(towel())))


def moved(millimetres: int) -> Drawing:
    return solve(pulled(TOWEL.drawing, 0, -0.001 * millimetres, 0.0)).drawing


def worked_on(seed: int, count: int) -> Iterator[Draft]:
    """Return drafts as a person makes them one after the other: commits, coalesced edits, previews, undo, redo."""
    rng, draft, now_s = random.Random(seed), TOWEL, 0.0
    for number in range(count):
        now_s += rng.choice([0.1, 5.0])
        drawing, label = moved(rng.randrange(5)), f"step {number}"
        ways: list[Edit | Callable[[Draft], Draft]] = [
            Draft.undone,
            Draft.redone,
            Edit(label, drawing),
            Edit(label, drawing, coalesce="run"),
            Edit(label, drawing, Phase.PREVIEW, gesture="drag"),
            Edit(label, None, Phase.CANCEL),
        ]
        wanted = rng.choice(ways)
        draft = draft.edited(wanted, now_s) if isinstance(wanted, Edit) else wanted(draft)
        yield draft
