"""The journal of a document, as versions before the database wrote it: a file that only grew.

The first line names the document and the format. Each further line is one change of the document's tape (see
`app.store.tape`) behind a checksum; the first of them is the whole tape. Reading skips a last line without an end, left
unfinished by a killed server. From time to time the journal was rewritten with the current tape.
"""

import zlib
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field
from pydantic_core import from_json

from app.drawing.drawing import Drawing
from app.drawing.drawing_json import DrawingModel
from app.store.tape import Sheet, Tape, TapeChange
from planner.strict_model import StrictModel

FORMAT = 2
"""The format number of journals."""

_Count = Annotated[int, Field(ge=0)]
_RawDrawing = dict[str, Any]
_CHECKSUM_BYTES = 9
"""Length of the checksum: eight hexadecimal digits and a space (bytes)."""


class JournalStart(StrictModel):
    """The first line; `generation` increases with each rewriting of the journal."""

    format: Literal[2]
    id: str
    generation: _Count


class _SheetModel(StrictModel):
    label: str
    drawing: _RawDrawing


class _ChangeModel(StrictModel):
    """A line with a change."""

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
    """The content of a journal.

    Attributes:
        id: the document's id.
        generation: the number of times it has been rewritten.
        version: the document's version.
        changed_at: the time of the last change, UTC, as in RFC 3339.
        raw_tape: the drawings as JSON.
        times: when each drawing of the tape was committed, as `changed_at`; empty where a rewriting forgot it.
        base_bytes: the length of its first two lines.
        whole_bytes: the length of all complete lines.
    """

    id: str
    generation: int
    version: int
    changed_at: str
    raw_tape: Tape[_RawDrawing]
    times: tuple[str, ...]
    base_bytes: int
    whole_bytes: int

    @property
    def raw_drawing(self) -> _RawDrawing:
        """The current drawing, as JSON."""
        return self.raw_tape.sheets[self.raw_tape.now].drawing

    def tape(self) -> Tape[Drawing]:
        """Return the drawings; raise `ValueError` or `FieldError` for an invalid one."""
        sheets, now = self.raw_tape
        drawings = (DrawingModel.model_validate(sheet.drawing).value() for sheet in sheets)
        return Tape(tuple(Sheet(sheet.label, drawing) for sheet, drawing in zip(sheets, drawings, strict=True)), now)


def read_journal(data: bytes) -> Journal:
    """Return the content of a journal; raise `ValueError` if it is damaged."""
    first, *lines = data.split(b"\n")
    rest = lines.pop() if lines else b""  # after the last line break
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
    times: tuple[str, ...] = ()
    for number, change in enumerate(changes):
        try:
            tape = tape.changed(change.value())
        except ValueError as error:
            raise ValueError(f"line {number + 2}: {error}") from None
        unknown = ("",) * (len(change.added) - 1)
        times = (*times[change.dropped :][: change.kept], *unknown, *((change.changed_at,) if change.added else ()))
    sizes = [len(line) + 1 for line in (first, *lines[: len(changes)])]
    last = changes[-1]
    return Journal(start.id, start.generation, last.version, last.changed_at, tape, times, sum(sizes[:2]), sum(sizes))


def _body(line: bytes) -> bytes | None:
    """Return the content of a line; None if its checksum is wrong."""
    checksum, body = line[:_CHECKSUM_BYTES], line[_CHECKSUM_BYTES:]
    return body if checksum == b"%08x " % zlib.crc32(body) else None
