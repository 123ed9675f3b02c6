"""Databases for tests: an SQLite file, and a PostgreSQL server of the tests' own, on a socket."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import create_engine, text

PROGRAMS = Path("/usr/lib/postgresql/15/bin")


@contextmanager
def postgresql() -> Iterator[str]:
    """Start a PostgreSQL server and yield the URL of its empty database; skip where there is no PostgreSQL."""
    if not (PROGRAMS / "initdb").exists():
        pytest.skip(f"there is no PostgreSQL in {PROGRAMS}")
    # PostgreSQL refuses to work for root, and a socket's path must be short.
    owner: dict[str, Any] = {"user": "postgres", "group": "postgres"} if os.geteuid() == 0 else {}
    folder = Path(tempfile.mkdtemp(prefix="pg"))
    if owner:
        shutil.chown(folder, **owner)
    quiet: dict[str, Any] = {"cwd": folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **owner}
    options = {"listen_addresses": "", "unix_socket_directories": folder, "fsync": "off", "shared_buffers": "16MB"}
    try:
        data = folder / "data"
        setup = ["--no-sync", "--no-instructions", "--auth=trust", "--username=pleat", "--encoding=UTF8", "--locale=C"]
        subprocess.run([PROGRAMS / "initdb", *setup, data], check=True, **quiet)
        given = [part for name, value in options.items() for part in ("-c", f"{name}={value}")]
        server = subprocess.Popen([PROGRAMS / "postgres", "-D", data, *given], **quiet)
        try:
            ready: list[str | Path] = [PROGRAMS / "pg_isready", "--quiet", "--host", folder]
            while subprocess.run(ready, **quiet).returncode:
                assert server.poll() is None, "PostgreSQL does not start"
            yield f"postgresql+psycopg://pleat@/postgres?host={folder}"
        finally:
            server.kill()
            server.wait()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def emptied(url: str) -> str:
    """Return the URL of a database after all tables in it were dropped."""
    engine = create_engine(url)
    with engine.begin() as connection:
        connection.execute(text("DROP SCHEMA public CASCADE"))
        connection.execute(text("CREATE SCHEMA public"))
    engine.dispose()
    return url
