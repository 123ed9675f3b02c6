import sqlite3
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import delete, func, select, text

from app.store import job_repository
from app.store.database import BadDatabaseUrlError, Database, OtherDatabaseError
from app.store.document_repository import DocumentRepository
from app.store.garment_repository import GarmentRepository
from app.store.job_repository import JobRepository, UnknownJobError
from app.store.schema import JobRow, Table
from app.store.storage_error import ForbiddenStorageError, StorageError
from tests.app.refused import refused
from tests.databases import emptied

TODAY = Path(__file__).parent / "today.sql"
"""A data folder's database with the tables of the first release: a document and a garment are in it."""


def test_the_migrations_lead_to_the_tables_of_the_code(database: Database) -> None:
    with database.engine().connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Table.metadata) == []


def test_a_data_folder_with_todays_tables_is_taken_over_with_all_that_is_in_it(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "pleat.db")) as file:
        file.executescript(TODAY.read_text())
    database = Database(tmp_path / "pleat.db")
    assert database.problem() is None
    with database.engine().connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Table.metadata) == []
    documents, garments = DocumentRepository(database), GarmentRepository(database)
    (listed,) = documents.page(None, 10).entries
    assert (listed.id, listed.title, listed.problem) == ("t93vw8un", "Towel", None)
    assert garments.garment("towel").folds == ()
    database.close()


@pytest.mark.parametrize("version", ["0006", "9999"])
def test_a_database_of_another_version_is_refused_and_left_alone(database: Database, version: str) -> None:
    with database.writing("try") as session:
        session.execute(text(f"UPDATE alembic_version SET version_num = '{version}'"))
    database.close()
    before = [] if database.path is None else [database.path.read_bytes()]
    with pytest.raises(OtherDatabaseError), database.reading("try"):
        pass
    assert before == ([] if database.path is None else [database.path.read_bytes()])


@pytest.mark.parametrize("url", ["", "nothing", "mysql://x/y", "sqlite:///x.db", "postgresql://u@h:port/x"])
def test_a_url_of_no_database_that_can_be_used_is_refused(tmp_path: Path, url: str) -> None:
    with pytest.raises(BadDatabaseUrlError):
        Database(tmp_path / "pleat.db", url)


def test_a_database_server_that_is_not_there_is_told_without_its_address(tmp_path: Path) -> None:
    database = Database(tmp_path / "pleat.db", f"postgresql://secret:word@/x?host={tmp_path}")
    problem = database.problem() or ""
    assert "cannot be reached" in problem
    assert not any(word in problem for word in ("secret", "word", str(tmp_path)))


def test_what_is_no_database_is_an_error_of_storage(tmp_path: Path) -> None:
    (tmp_path / "pleat.db").write_bytes(b"no database" * 1000)
    database = Database(tmp_path / "pleat.db")
    assert "not a database" in (database.problem() or "")
    with pytest.raises(StorageError):
        JobRepository(database).add("kind", "me", "", {})


def test_a_change_that_fails_is_undone_and_a_reader_sees_one_moment(database: Database) -> None:
    jobs = JobRepository(database)
    first = jobs.add("kind", "me", "", {})
    with pytest.raises(RuntimeError), database.writing("try") as session:
        session.execute(delete(JobRow))
        raise RuntimeError
    with database.reading("look") as session:
        count = select(func.count()).select_from(JobRow)
        assert session.scalar(count) == 1
        jobs.add("kind", "me", "", {})
        assert session.scalar(count) == 1
    assert [job.id for job in jobs.newest(10)][1:] == [first.id]


def test_many_threads_may_write_at_once(database: Database) -> None:
    jobs = JobRepository(database)
    with ThreadPoolExecutor(8) as threads:
        made = list(threads.map(lambda number: jobs.add("kind", "me", "", number).id, range(40)))
    assert {job.id for job in jobs.newest(100)} == set(made)


def test_in_a_folder_that_cannot_be_written_there_is_a_copy_in_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written = Database(tmp_path / "pleat.db")
    job = JobRepository(written).add("kind", "me", "", {})  # it is in the write-ahead log only
    before = (tmp_path / "pleat.db").read_bytes()
    with refused(monkeypatch, tmp_path, "EROFS", databases_too=False):
        copied = Database(tmp_path / "pleat.db")
        jobs = JobRepository(copied)
        assert jobs.job(job.id) == job
        assert jobs.add("kind", "me", "", {}).id in [one.id for one in jobs.newest(10)]
        with pytest.raises(ForbiddenStorageError), copied.writing("try"):
            pass
    copied.close()
    assert (tmp_path / "pleat.db").read_bytes() == before
    assert [one.id for one in JobRepository(written).newest(10)] == [job.id]
    written.close()


def test_what_is_committed_survives_a_copy_of_the_files_at_that_moment(tmp_path: Path) -> None:
    database = Database(tmp_path / "pleat.db")
    job = JobRepository(database).add("kind", "me", "", {"number": 1})
    (tmp_path / "copy").mkdir()
    for file in tmp_path.glob("pleat.db*"):
        (tmp_path / "copy" / file.name).write_bytes(file.read_bytes())
    database.close()
    copied = Database(tmp_path / "copy" / "pleat.db")
    assert JobRepository(copied).job(job.id) == job
    assert JobRepository(copied).body(job.id) == {"number": 1}
    copied.close()


def test_only_the_newest_jobs_are_kept_and_all_open_ones(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(job_repository, "KEPT_MAX", 3)
    repository = JobRepository(database)
    still_open, done = repository.add("kind", "me", "", {}), repository.add("kind", "me", "", {})
    repository.keep_result(replace(done, status="done"), 1)
    newest = [repository.add("kind", "me", "", {}) for _ in range(3)]
    assert [job.id for job in repository.newest(10)] == [*reversed([job.id for job in newest]), still_open.id]
    with pytest.raises(UnknownJobError):
        repository.job(done.id)


def test_a_server_takes_up_only_the_jobs_of_servers_that_have_ended(tmp_path: Path, postgresql_server: str) -> None:
    url = emptied(postgresql_server)
    first, second = Database(tmp_path / "x", url), Database(tmp_path / "x", url)
    job = JobRepository(first).add("kind", "me", "", {})
    assert JobRepository(second).interrupted() == []
    first.close()
    assert JobRepository(second).interrupted() == [job]
    third = Database(tmp_path / "x", url)
    assert JobRepository(third).interrupted() == []
    for database in (second, third):
        database.close()
