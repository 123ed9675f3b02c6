"""Takes documents and garments over from the files in which versions before the database kept them.

All of them go into the database in one transaction. Then the files are moved to a folder beside, where they are kept;
a server that is killed in between finds them again at its next start, knows by their ids that they are there already,
and moves them.
"""

import logging
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic_core import to_json
from sqlalchemy import insert, select
from sqlalchemy.orm import Session

from app.drawing.drawing_json import drawing_to_dict
from app.store.data_folder import DataFolder
from app.store.database import Database
from app.store.document_keeper import FORMAT
from app.store.document_repository import ID_PATTERN
from app.store.durable_file import sync_folder
from app.store.older.document_files import BROKEN, JOURNAL, JSON, DocumentFiles
from app.store.older.read_files import OlderDocument, UnreadableFile, read_files
from app.store.schema import DocumentRow, GarmentRow, StepRow
from app.store.storage_error import storing

TAKEN_OVER = "before-database"
"""The folder in which the files are kept."""

_LAST = ".last"
"""The file with the id of the document opened last."""

_log = logging.getLogger(__name__)


def take_over(folder: DataFolder, database: Database) -> None:
    """Take all documents and garments over that are files in a data folder; in a read-only one the files stay.

    Raises:
        StorageError: the system or the database refuses; nothing is taken over then.
        NewerDatabaseError: a newer version of Pleat has changed the tables.
    """
    folders = [path for path in (folder.documents, folder.garments) if path.is_dir()]
    if not folders:
        return
    what = "what older versions have kept could not be taken over"
    with storing(what):
        with database.writing(what, is_lasting=False) as session:
            known = set(session.scalars(select(DocumentRow.id)))
            ids = sorted(_ids(folder.documents) - known)
            for document_id in ids:
                _add_document(session, DocumentFiles(document_id, folder.documents))
            _remember_last(session, folder.documents / _LAST, ids)
            names = set(session.scalars(select(GarmentRow.name)))
            garments = [path for path in sorted(folder.garments.glob("*.json")) if path.stem not in names]
            for path in garments:
                content = path.read_bytes().decode("utf-8", "replace").replace("\0", "")
                session.execute(insert(GarmentRow).values(name=path.stem, content=content))
        if database.is_copy:
            return
        kept = _new_folder(folder.path)
        for path in folders:
            path.rename(kept / path.name)
        sync_folder(kept)
        sync_folder(folder.path)
    _log.warning("%d documents and %d garments are in the database now; %s", len(ids), len(garments), kept)


def _ids(folder: Path) -> set[str]:
    shown = (path for path in folder.glob("*") if path.suffix in (JOURNAL, JSON, BROKEN))
    return {path.stem for path in shown if ID_PATTERN.fullmatch(path.stem)}


def _new_folder(beside: Path) -> Path:
    """Return a new, empty folder for files that were taken over."""
    for number in range(1, 1000):
        folder = beside / (TAKEN_OVER if number == 1 else f"{TAKEN_OVER}-{number}")
        if not folder.exists():
            folder.mkdir()
            return folder
    raise FileExistsError(17, "there are a thousand already", str(beside / TAKEN_OVER))


def _remember_last(session: Session, file: Path, ids: list[str]) -> None:
    """Let the document that was opened last be the first to be shown again."""
    try:
        document_id = file.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return
    if document_id in ids:
        row = session.get_one(DocumentRow, document_id)
        row.opened_s = time.time()


def _add_document(session: Session, files: DocumentFiles) -> None:
    found = read_files(files)
    if isinstance(found, UnreadableFile):
        where = f"its file is kept in {TAKEN_OVER!r}"
        problem = found.why if found.format else f"{found.why}; {where}"
        row = _row(files.id, format=found.format, revision=0, version=1, first=0, now=0, problem=problem)
        session.execute(insert(DocumentRow).values(row))
        return
    sheets, now = found.tape
    drawing, preview = sheets[now].drawing, found.preview
    row = _row(
        files.id,
        format=FORMAT,
        revision=0,
        version=found.version,
        changed_at=found.changed_at,
        title=drawing.title,
        name=drawing.name,
        first=0,
        now=now,
        start=None if found.start is None else _json(found.start.to_dict()),
    )
    if preview is not None:
        shown = _json(drawing_to_dict(preview.drawing.value()))
        row |= {"preview_version": preview.version, "preview_label": preview.label, "preview": shown}
    session.execute(insert(DocumentRow).values(row))
    session.execute(insert(StepRow), list(_steps(files.id, found)))


def _steps(document_id: str, found: OlderDocument) -> Iterator[dict[str, Any]]:
    for number, (sheet, changed_at) in enumerate(zip(found.tape.sheets, found.times, strict=True)):
        drawing = _json(drawing_to_dict(sheet.drawing))
        yield {
            "document_id": document_id,
            "number": number,
            "label": sheet.label,
            "changed_at": changed_at,
            "drawing": drawing,
        }


def _row(document_id: str, **values: Any) -> dict[str, Any]:  # noqa: ANN401
    return {"id": document_id, "changed_at": "", "title": "", "name": "", **values}


def _json(value: object) -> str:
    return to_json(value).decode()
