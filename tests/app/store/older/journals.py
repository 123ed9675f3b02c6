"""Journals as versions before the database wrote them."""

import zlib
from pathlib import Path

from pydantic_core import to_json

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_to_dict
from app.store.older.journal import FORMAT
from app.store.tape import TapeChange, tape_of, whole


def start_line(document_id: str, generation: int) -> bytes:
    """Return the first line of a journal."""
    return to_json({"format": FORMAT, "id": document_id, "generation": generation}) + b"\n"


def change_line(version: int, changed_at: str, change: TapeChange[Drawing]) -> bytes:
    """Return the line of a change."""
    added = [{"label": sheet.label, "drawing": drawing_to_dict(sheet.drawing)} for sheet in change.added]
    body = to_json(
        {
            "version": version,
            "changed_at": changed_at,
            "dropped": change.dropped,
            "kept": change.kept,
            "added": added,
            "now": change.now,
        }
    )
    return b"%08x %b\n" % (zlib.crc32(body), body)


def put_journal(folder: Path, document_id: str, drafts: list[Draft]) -> Path:
    """Write the journal of a document that went through these drafts, with its head."""
    folder.mkdir(exist_ok=True)
    tapes = [tape_of(draft.drawing, draft.history) for draft in drafts]
    text = start_line(document_id, 0) + change_line(1, "2026-01-01T00:00:00.000Z", whole(tapes[0]))
    for number, after in enumerate(tapes[1:]):
        text += change_line(number + 2, f"2026-01-02T00:00:{number % 60:02}.000Z", tapes[number].change_to(after))
    drawing = drafts[-1].drawing
    head = {"id": document_id, "generation": 0, "bytes": len(text)}
    head |= {"title": drawing.title, "name": drawing.name, "changed_at": "2026-01-02T00:00:00.000Z"}
    path = folder / f"{document_id}.journal"
    path.write_bytes(text)
    path.with_suffix(".head").write_bytes(to_json(head))
    return path
