"""The results of a study, kept as they come in: a SQLite file in the study's folder.

SQLite rather than a file that only grows: answers come in any order, and the table is written in the cells' order
without holding it in memory; a commit is whole or not at all, also when the program is killed in the middle; the lock
ends with the program. A commit costs some 50 microseconds, because it waits for no disk: a power cut may lose the last
answers, never the file.
"""

import json
import sqlite3
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from app.studies.answer import FAILED, Answer
from app.studies.fields import StudyFolderError
from app.studies.study import Study

FILE = "results.sqlite"
PLANS = "plans"
"""The folder of the plans that are kept."""

_LAYOUT = """
CREATE TABLE IF NOT EXISTS study (id INTEGER PRIMARY KEY CHECK (id = 0), digest TEXT NOT NULL, content TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS answer (cell INTEGER PRIMARY KEY, row TEXT NOT NULL, timing TEXT NOT NULL);
"""


class Results:
    """The answers known so far; only one process at a time can have them open."""

    def __init__(self, folder: Path) -> None:
        """Open the results in a folder, which is made where it is missing.

        Raises:
            StudyFolderError: another process has them open, or the file is none of ours.
            OSError: the folder cannot be made.
        """
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._file = sqlite3.connect(folder / FILE, timeout=0.0, isolation_level=None, check_same_thread=False)
        try:
            self._file.execute("PRAGMA locking_mode = EXCLUSIVE")
            self._file.execute("PRAGMA journal_mode = WAL")
            self._file.execute("PRAGMA synchronous = NORMAL")
            self._file.executescript(f"BEGIN IMMEDIATE;{_LAYOUT}COMMIT;")
        except sqlite3.DatabaseError as error:
            self._file.close()
            if error.sqlite_errorcode == sqlite3.SQLITE_BUSY:
                raise StudyFolderError(f"{folder}: a study is under way there") from None
            raise StudyFolderError(f"{folder / FILE}: holds no results of a study ({error})") from None

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> "Results":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def study(self) -> Study | None:
        """Return the study whose results these are; None for a new folder."""
        found = self._file.execute("SELECT content FROM study").fetchone()
        return None if found is None else Study.from_dict(json.loads(found[0]))

    def begin(self, study: Study, *, resume: bool) -> None:
        """Begin a study, or go on with it.

        Args:
            study: the study.
            resume: whether to keep the answers that are known.

        Raises:
            StudyFolderError: the answers are those of another study.
        """
        before = self.study()
        if not resume:
            self._file.execute("DELETE FROM answer")
        elif before is not None and before.digest != study.digest:
            raise StudyFolderError(
                f"{self.folder}: holds the results of another study, or the study has changed: "
                f"{_difference(before, study)}. Give another folder, or --no-resume to begin anew and drop them"
            )
        content = json.dumps(study.to_dict())
        self._file.execute("INSERT OR REPLACE INTO study VALUES (0, ?, ?)", (study.digest, content))

    def add(self, answer: Answer) -> None:
        """Keep an answer, its plan first."""
        if answer.plan is not None:
            plans = self.folder / PLANS
            plans.mkdir(exist_ok=True)
            (plans / f"{answer.row['plan_id']}.plan.json.gz").write_bytes(answer.plan)
        values = (answer.index, json.dumps(answer.row), json.dumps(answer.timing))
        self._file.execute("INSERT OR REPLACE INTO answer VALUES (?, ?, ?)", values)

    def forget_failed(self) -> None:
        """Drop the answers that are failures, so that their cells are planned again."""
        self._file.execute("DELETE FROM answer WHERE json_extract(row, '$.status') = ?", (FAILED,))

    def known(self) -> Iterator[int]:
        """Yield the numbers of the cells that have answers, ascending."""
        for (cell,) in self._file.execute("SELECT cell FROM answer ORDER BY cell"):
            yield cell

    def rows(self) -> Iterator[tuple[int, Mapping[str, Any], Mapping[str, float]]]:
        """Yield cell, row and timing of all answers, by cell."""
        for cell, row, timing in self._file.execute("SELECT cell, row, timing FROM answer ORDER BY cell"):
            yield cell, json.loads(row), json.loads(timing)


def _difference(before: Study, now: Study) -> str:
    """Return in what two studies differ, by the names of their axes."""
    old, new = ({axis.name: axis.values for axis in one.all_axes} for one in (before, now))
    changed = [name for name in {**old, **new} if old.get(name) != new.get(name)]
    if changed:
        return f"the values of {', '.join(changed)}"
    if before.sample != now.sample:
        return "the sample"
    if before.scene != now.scene:
        return "the stations"
    if before.has_comfort_margin != now.has_comfort_margin:
        return "`comfort_margin`"
    if before.rehearsal != now.rehearsal:
        return "the rehearsal"
    return "a garment's drawing, or a placement"
