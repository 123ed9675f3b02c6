import sqlite3
from dataclasses import replace
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import create_engine

from app.store import job_repository
from app.store.database import Database, NewerDatabaseError
from app.store.job_repository import JobRepository, UnknownJobError
from app.store.schema import Table
from app.store.storage_error import StorageError


def test_the_migrations_lead_to_the_tables_of_the_code(tmp_path: Path) -> None:
    database = Database(tmp_path / "pleat.db")
    assert database.problem() is None
    database.close()
    engine = create_engine(f"sqlite:///{tmp_path / 'pleat.db'}")
    with engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Table.metadata) == []
    engine.dispose()


def test_a_database_of_a_newer_version_is_refused_and_left_alone(tmp_path: Path) -> None:
    database = Database(tmp_path / "pleat.db")
    assert database.problem() is None
    database.close()
    raw = sqlite3.connect(tmp_path / "pleat.db")
    with raw:
        raw.execute("UPDATE alembic_version SET version_num = '9999'")
    raw.close()
    before = (tmp_path / "pleat.db").read_bytes()
    with pytest.raises(NewerDatabaseError), database.session("try"):
        pass
    assert (tmp_path / "pleat.db").read_bytes() == before


def test_what_is_no_database_is_an_error_of_storage(tmp_path: Path) -> None:
    (tmp_path / "pleat.db").write_bytes(b"no database" * 1000)
    database = Database(tmp_path / "pleat.db")
    assert "not a database" in (database.problem() or "")
    with pytest.raises(StorageError):
        JobRepository(database).add("kind", "me", {})


def test_what_is_committed_survives_a_copy_of_the_files_at_that_moment(tmp_path: Path) -> None:
    database = Database(tmp_path / "pleat.db")
    job = JobRepository(database).add("kind", "me", {"number": 1})
    (tmp_path / "copy").mkdir()
    for file in tmp_path.glob("pleat.db*"):
        (tmp_path / "copy" / file.name).write_bytes(file.read_bytes())
    database.close()
    copied = Database(tmp_path / "copy" / "pleat.db")
    assert JobRepository(copied).job(job.id) == job
    assert JobRepository(copied).body(job.id) == {"number": 1}
    copied.close()


def test_only_the_newest_jobs_are_kept_and_all_open_ones(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(job_repository, "KEPT_MAX", 3)
    database = Database(tmp_path / "pleat.db")
    repository = JobRepository(database)
    still_open, done = repository.add("kind", "me", {}), repository.add("kind", "me", {})
    repository.keep_result(replace(done, status="done"), 1)
    newest = [repository.add("kind", "me", {}) for _ in range(3)]
    assert [job.id for job in repository.newest(10)] == [*reversed([job.id for job in newest]), still_open.id]
    with pytest.raises(UnknownJobError):
        repository.job(done.id)
    database.close()
