import io
import os
import tarfile
import threading
from pathlib import Path

import pytest

from app.drawing.draft import draft_of
from app.drawing.garment_drawing import drawing_of
from app.store.backup import NoBackupError, UsedDatabaseError, UsedFolderError, back_up, restore
from app.store.data_folder import DataFolder
from app.store.database import Database
from app.store.document_repository import DocumentRepository
from app.store.garment_repository import GarmentRepository
from app.store.job_repository import JobRepository
from planner.cloth.garment import Garment
from tests.app.samples import towel
from tests.databases import emptied


@pytest.mark.parametrize("kind", ["sqlite", "postgresql"])
def test_a_restored_folder_has_documents_garments_and_jobs_while_the_server_works_on(
    tmp_path: Path, database: Database, database_url: str | None, kind: str, request: pytest.FixtureRequest
) -> None:
    """From a database of each kind to one of each kind."""
    folder = DataFolder(tmp_path)
    garment = Garment.from_dict(towel(name="my-towel"))
    GarmentRepository(database).save(garment)
    documents = DocumentRepository(database)
    jobs = [JobRepository(database).add("kind", "me", "", {"number": number}) for number in range(2)]
    ids = [documents.new_id() for _ in range(3)]
    keepers = {document_id: documents.keeper(document_id) for document_id in ids}
    draft = draft_of(drawing_of(garment))
    for keeper in keepers.values():
        keeper.keep(1, draft)
    is_over = threading.Event()

    def work() -> None:
        version = 1
        while not is_over.wait(0.002):
            version += 1
            keepers[ids[0]].keep(version, draft)

    working = threading.Thread(target=work)
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies" / "mine").write_text("a study")
    target = tmp_path / ".backups"
    target.mkdir()
    with folder.held():
        working.start()
        try:
            for number in range(2):
                back_up(folder, target / f"{number}.tar.gz", database_url)
        finally:
            is_over.set()
            working.join()
    database.close()
    for number in range(2):
        into = emptied(request.getfixturevalue("postgresql_server")) if kind == "postgresql" else None
        restored = DataFolder(target / f"restored-{number}")
        restore(target / f"{number}.tar.gz", restored, into)
        copied = Database(restored.database, into)
        again = DocumentRepository(copied)
        assert all(again.kept(document_id).draft.history == draft.history for document_id in ids)
        assert GarmentRepository(copied).garment("my-towel") == garment
        assert JobRepository(copied).newest(10) == jobs[::-1]
        JobRepository(copied).add("kind", "me", "", {})
        copied.close()
        assert (restored.path / "studies" / "mine").read_text() == "a study"
        assert not (restored.path / "server.json").exists()
        assert restored.database.exists() == (into is None)
        if into is not None:
            with pytest.raises(UsedDatabaseError):
                restore(target / f"{number}.tar.gz", DataFolder(target / "once-more"), into)
            assert not (target / "once-more").exists()


def test_only_their_owner_can_read_a_database_a_backup_and_what_is_restored(tmp_path: Path) -> None:
    before = os.umask(0o022)
    try:
        database = Database(tmp_path / "data" / "pleat.db")
        assert database.problem() is None
        back_up(DataFolder(tmp_path / "data"), tmp_path / "a.tar.gz")
        database.close()
        restore(tmp_path / "a.tar.gz", DataFolder(tmp_path / "again"))
        again = Database(tmp_path / "again" / "pleat.db")
        assert again.problem() is None
        again.close()
    finally:
        os.umask(before)
    for path in (tmp_path / "a.tar.gz", *tmp_path.glob("*/pleat.db*")):
        assert path.stat().st_mode & 0o777 == 0o600, path


def test_nothing_is_restored_over_something(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    back_up(DataFolder(tmp_path / "data"), tmp_path / "a.tar.gz")
    restore(tmp_path / "a.tar.gz", DataFolder(tmp_path / "data"))
    (tmp_path / "data" / "mine").write_text("x")
    with pytest.raises(UsedFolderError):
        restore(tmp_path / "a.tar.gz", DataFolder(tmp_path / "data"))
    assert (tmp_path / "data" / "mine").read_text() == "x"


@pytest.mark.parametrize("content", [b"", b"no archive", None])
def test_what_is_no_backup_is_refused_and_leaves_nothing(tmp_path: Path, content: bytes | None) -> None:
    source = tmp_path / "a.tar.gz"
    if content is None:
        with tarfile.open(source, "w:gz") as archive:
            archive.addfile(tarfile.TarInfo("pleat.db"), io.BytesIO())
    else:
        source.write_bytes(content)
    with pytest.raises(NoBackupError):
        restore(source, DataFolder(tmp_path / "data"))
    assert list(tmp_path.iterdir()) == [source]


def test_a_backup_leads_nowhere_outside(tmp_path: Path) -> None:
    source = tmp_path / "a.tar.gz"
    with tarfile.open(source, "w:gz") as archive:
        for name, content in (("pleat-backup.json", b'{"format": 1}'), ("../outside", b"x")):
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    with pytest.raises(NoBackupError):
        restore(source, DataFolder(tmp_path / "below" / "data"))
    assert not list(tmp_path.rglob("outside"))


def test_a_folder_that_is_not_there_is_not_backed_up(tmp_path: Path) -> None:
    with pytest.raises(NoBackupError):
        back_up(DataFolder(tmp_path / "nothing"), tmp_path / "a.tar.gz")
    assert not (tmp_path / "a.tar.gz").exists()
