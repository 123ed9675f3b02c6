"""The journal of a document: a file that only grows.

The first line says which document and which format it is. Every further line is one change of the document's tape (see
`app.store.tape`) behind a checksum, the first of them the whole tape. A line counts once it ends: a last one that a
server left unfinished when it was killed is left out. Now and then the journal is begun anew with the tape as it is.
"""

import zlib
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field
from pydantic_core import from_json, to_json

from app.drawing.drawing import Drawing
from app.drawing.drawing_json import DrawingModel, drawing_to_dict
from app.store.tape import Sheet, Tape, TapeChange
from planner.strict_model import StrictModel

FORMAT = 2

_Count = Annotated[int, Field(ge=0)]
_RawDrawing = dict[str, Any]
_CHECKSUM_BYTES = 9
"""Eight hexadecimal digits and a space."""


class JournalStart(StrictModel):
    """The first line: `generation` grows whenever the journal is begun anew."""

    format: Literal[2]
    id: str
    generation: _Count


class _SheetModel(StrictModel):
    label: str
    drawing: _RawDrawing


class _ChangeModel(StrictModel):
    """A line."""

    version: Annotated[int, Field(ge=1)]
    changed_at: str
    dropped: _Count
    kept: _Count
    added: list[_SheetModel]
    now: _Count

    def value(self) -> TapeChange[_RawDrawing]:
        added = tuple(Sheet(sheet.label, sheet.drawing) for sheet in self.added)
        return TapeChange(self.dropped, self.kept, added, self.now)


@dataclass(frozen=True, slots=True)
class Journal:
    """What a journal says.

    Attributes:
        id: the document.
        generation: how often it has been begun anew.
        version: the document's version.
        changed_at: when it was changed last, UTC, as in RFC 3339.
        raw_tape: the drawings as JSON.
        base_bytes: the length of its first two lines.
        whole_bytes: the length of all whole lines.
    """

    id: str
    generation: int
    version: int
    changed_at: str
    raw_tape: Tape[_RawDrawing]
    base_bytes: int
    whole_bytes: int

    @property
    def raw_drawing(self) -> _RawDrawing:
        """What is drawn, as JSON."""
        return self.raw_tape.sheets[self.raw_tape.now].drawing

    def tape(self) -> Tape[Drawing]:
        """Return the drawings; raises `ValueError` or `FieldError` for what is none."""
        sheets, now = self.raw_tape
        drawings = (DrawingModel.model_validate(sheet.drawing).value() for sheet in sheets)
        return Tape(tuple(Sheet(sheet.label, drawing) for sheet, drawing in zip(sheets, drawings, strict=True)), now)


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


def read_journal(data: bytes) -> Journal:
    """Return what a journal says; raises `ValueError` for one that is damaged."""
    first, *lines = data.split(b"\n")
    rest = lines.pop() if lines else b""  # behind the last line's end
    start = JournalStart.model_validate_json(first)
    bodies = [_body(line) for line in lines]
    if bodies and bodies[-1] is None and not rest:
        bodies.pop()
    if None in bodies:
        raise ValueError(f"line {bodies.index(None) + 2} is damaged")
    changes = [_ChangeModel.model_validate(from_json(body)) for body in bodies if body is not None]
    if not changes:
        raise ValueError("it ends before the first drawing")
    tape: Tape[_RawDrawing] = Tape((), 0)
    for number, change in enumerate(changes):
        try:
            tape = tape.changed(change.value())
        except ValueError as error:
            raise ValueError(f"line {number + 2}: {error}") from None
    sizes = [len(line) + 1 for line in (first, *lines[: len(changes)])]
    last = changes[-1]
    return Journal(start.id, start.generation, last.version, last.changed_at, tape, sum(sizes[:2]), sum(sizes))


def _body(line: bytes) -> bytes | None:
    """What a line says; None if it is damaged."""
    checksum, body = line[:_CHECKSUM_BYTES], line[_CHECKSUM_BYTES:]
    return body if checksum == b"%08x " % zlib.crc32(body) else None
