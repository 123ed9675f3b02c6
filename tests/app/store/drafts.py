"""Drafts to be stored, and documents in the format from before journals."""

import json
import random
from collections.abc import Iterator

from app.drawing.draft import Draft, draft_of
from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_to_dict
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
        edits = [
            Edit(label, drawing),
            Edit(label, drawing, coalesce="run"),
            Edit(label, drawing, Phase.PREVIEW, gesture="drag"),
            Edit(label, None, Phase.CANCEL),
        ]
        wanted = rng.choice([Draft.undone, Draft.redone, *edits])
        draft = draft.edited(wanted, now_s) if isinstance(wanted, Edit) else wanted(draft)
        yield draft


def older_file(document_id: str, version: int, draft: Draft, format_: int = 1) -> str:
    """Return a document's file of format 1."""
    header = {
        "format": format_,
        "id": document_id,
        "version": version,
        "title": draft.drawing.title,
        "name": draft.drawing.name,
        "changed_at": "2026-01-02T03:04:05.678Z",
    }
    past, future = (
        ",\n".join(json.dumps({"label": step.label, "drawing": drawing_to_dict(step.drawing)}) for step in steps)
        for steps in (draft.history.past, draft.history.future)
    )
    drawn = json.dumps(drawing_to_dict(draft.drawing))
    return f'{json.dumps(header)[:-1]},\n"drawing": {drawn},\n"past": [{past}],\n"future": [{future}]}}\n'
