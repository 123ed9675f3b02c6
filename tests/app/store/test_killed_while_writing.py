"""A process that is killed while it writes loses nothing that it has acknowledged."""

import itertools
import subprocess
import sys
from pathlib import Path

from app.document import Document
from app.drawing.edit import Edit
from app.store.database import Database
from app.store.document_errors import UnknownDocumentError
from app.store.document_repository import DocumentRepository
from tests.app.store.drafts import TOWEL, moved

ID = "abcd2345"
_DRAWINGS = [moved(millimetres) for millimetres in range(1, 8)]


def edit_for_ever(folder: Path, url: str | None) -> None:
    """Change a document, new or old, and print each version once it is stored."""
    repository = DocumentRepository(Database(folder / "pleat.db", url))
    try:
        kept = repository.kept(ID)
        version, draft, keeper = kept.version, kept.draft, kept.keeper
    except UnknownDocumentError:
        version, draft, keeper = 1, TOWEL, repository.keeper(ID)
        keeper.keep(1, TOWEL)
    document = Document(draft, version=version, keep=keeper.keep)
    for number in itertools.count(version):
        print(document.edit(Edit(f"to {number}", _DRAWINGS[number % 7])).version, flush=True)


def test_after_a_kill_at_any_time_everything_is_there_that_was_acknowledged(
    tmp_path: Path, database: Database, repository: DocumentRepository, database_url: str | None
) -> None:
    acknowledged = 1
    given = f"Path({str(tmp_path)!r}), {database_url!r}"
    command = f"from pathlib import Path; from {__name__} import edit_for_ever; edit_for_ever({given})"
    for count in (15, 3):
        writer = subprocess.Popen([sys.executable, "-c", command], stdout=subprocess.PIPE, text=True)
        assert writer.stdout is not None
        lines = [writer.stdout.readline() for _ in range(count)]
        writer.kill()
        lines += writer.communicate()[0].split("\n")[:-1]
        acknowledged = max(acknowledged, *map(int, lines))
        kept = repository.kept(ID)
        assert kept.version in (acknowledged, acknowledged + 1)
        assert kept.draft.drawing == _DRAWINGS[(kept.version - 1) % 7]
        labels = [step.label for step in kept.draft.history.past]
        assert labels == [f"to {number}" for number in range(1, kept.version)][-200:]
        assert repository.page(None, 10).entries[0].problem is None
