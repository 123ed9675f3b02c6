"""A process that is killed while it writes loses nothing that it has acknowledged."""

import itertools
import random
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import settings

from app.document import Document
from app.drawing.edit import Edit
from app.store.database import Database
from app.store.document_errors import UnknownDocumentError
from app.store.document_repository import DocumentRepository
from tests.app.store.drafts import TOWEL, moved
from tests.laws.law import LONG

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
    tmp_path: Path, repository: DocumentRepository, database_url: str | None
) -> None:
    kill_often(tmp_path, repository, database_url, [(15, 0.0), (3, 0.0)])


@pytest.mark.slow
@pytest.mark.skipif(settings.get_current_profile_name() != LONG, reason="a hundred processes: make test-long")
def test_after_a_hundred_kills_everything_is_there_that_was_acknowledged(
    tmp_path: Path, repository: DocumentRepository, database_url: str | None
) -> None:
    rng = random.Random(1)
    kill_often(tmp_path, repository, database_url, [(rng.randrange(1, 8), rng.uniform(0.0, 0.03)) for _ in range(100)])


def kill_often(
    tmp_path: Path, repository: DocumentRepository, database_url: str | None, moments: Sequence[tuple[int, float]]
) -> None:
    """Kill one writer after the other, each after some acknowledgements and a time (s); assert that nothing is lost."""
    acknowledged = 1
    given = f"Path({str(tmp_path)!r}), {database_url!r}"
    command = f"from pathlib import Path; from {__name__} import edit_for_ever; edit_for_ever({given})"
    for count, wait_s in moments:
        writer = subprocess.Popen([sys.executable, "-c", command], stdout=subprocess.PIPE, text=True)
        assert writer.stdout is not None
        lines = [writer.stdout.readline() for _ in range(count)]
        time.sleep(wait_s)
        writer.kill()
        lines += writer.communicate()[0].split("\n")[:-1]
        acknowledged = max(acknowledged, *map(int, lines))
        kept = repository.kept(ID)
        assert kept.version in (acknowledged, acknowledged + 1)
        assert kept.draft.drawing == _DRAWINGS[(kept.version - 1) % 7]
        labels = [step.label for step in kept.draft.history.past]
        assert labels == [f"to {number}" for number in range(1, kept.version)][-200:]
        assert repository.page(None, 10).entries[0].problem is None
