"""The studies that are done, in the database; a folder for each, in which it is planned and goes on where it was."""

import re
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import delete, insert, select

from app.store.database import Database
from app.store.schema import StudyFileRow, StudyRow
from planner.errors import FoldingError

ID_PATTERN = re.compile(r"[0-9a-f]{32}")


@dataclass
class UnknownStudyError(FoldingError):
    """No study has this id, or it has no such file."""

    study_id: str

    def __str__(self) -> str:
        return f"there is no study with the id {self.study_id[:80]!r}, or it is not done"


class StudyStore:
    """The studies of a server; safe to use from any thread.

    Attributes:
        folder: the folder in which they are planned.
    """

    def __init__(self, folder: Path, database: Database) -> None:
        """Use a folder and a database; read nothing yet."""
        self.folder = folder
        self._database = database

    def keep(self, study_id: str, title: str, content: str, files: Mapping[str, bytes]) -> None:
        """Save a study that is done, instead of what was known of it.

        Args:
            study_id: its id.
            title: its title.
            content: the study as JSON.
            files: its table and report, by name.

        Raises:
            StorageError: the database refuses.
        """
        row = {"id": study_id, "title": title.replace("\0", ""), "done_s": time.time(), "content": content}
        with self._database.writing(f"study {study_id} could not be kept") as session:
            session.execute(delete(StudyFileRow).where(StudyFileRow.study_id == study_id))
            session.execute(delete(StudyRow).where(StudyRow.id == study_id))
            session.execute(insert(StudyRow), row)
            rows = [{"study_id": study_id, "name": name, "content": file} for name, file in files.items()]
            session.execute(insert(StudyFileRow), rows)

    def file(self, study_id: str, name: str) -> bytes:
        """Return a file of a study; raise `UnknownStudyError` if there is none."""
        with self._database.reading(f"study {_checked(study_id)} could not be read") as session:
            found = session.get(StudyFileRow, (study_id, name))
        if found is None:
            raise UnknownStudyError(study_id)
        return found.content

    def content(self, study_id: str) -> str:
        """Return a study as JSON; raise `UnknownStudyError` if there is none."""
        with self._database.reading(f"study {_checked(study_id)} could not be read") as session:
            found = session.scalar(select(StudyRow.content).where(StudyRow.id == study_id))
        if found is None:
            raise UnknownStudyError(study_id)
        return found

    def known(self) -> frozenset[str]:
        """Return the ids of all studies that are done."""
        with self._database.reading("the studies could not be read") as session:
            return frozenset(session.scalars(select(StudyRow.id)))


def _checked(study_id: str) -> str:
    """Return an id; raise `UnknownStudyError` if it cannot be one."""
    if not ID_PATTERN.fullmatch(study_id):
        raise UnknownStudyError(study_id)
    return study_id
