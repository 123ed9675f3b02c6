"""Fixtures: a server without a network, and one that really listens."""

from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from pathlib import Path

import httpx
import pytest

from app.api.create_app import create_app
from app.settings import Settings
from app.store.database import Database
from tests.app.job_works import suggest_with_own_robot
from tests.app.nursery import forked
from tests.databases import emptied, postgresql
from tests.patience import PATIENCE_S

OWN_URL = "http://127.0.0.1:8000"


REST = httpx.Client(limits=httpx.Limits(max_keepalive_connections=0), timeout=PATIENCE_S)
"""A shared client: `httpx.get` reads the system's certificates at each call, which takes longer than the call."""


@pytest.fixture
def own_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let searches for suggestions try no other robot."""
    monkeypatch.setattr("app.searches.suggest", suggest_with_own_robot)


@pytest.fixture
def anyio_backend() -> str:
    return "asyncio"


@pytest.fixture(scope="session")
def postgresql_server() -> Iterator[str]:
    """Return the URL of the database of a PostgreSQL server that all tests of this process share."""
    with postgresql() as url:
        yield url


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest) -> str | None:
    """Return None for SQLite, and the URL of an empty PostgreSQL database."""
    return None if request.param == "sqlite" else emptied(request.getfixturevalue("postgresql_server"))


@pytest.fixture
def database(tmp_path: Path, database_url: str | None) -> Iterator[Database]:
    """Return an empty database, of each kind in turn."""
    database = Database(tmp_path / "pleat.db", database_url)
    yield database
    database.close()


@pytest.fixture
async def client(tmp_path: Path) -> AsyncIterator[httpx.AsyncClient]:
    """Return a client of a server without a network; no document is open in it."""
    async with client_of(tmp_path) as client:
        yield client


@asynccontextmanager
async def client_of(data: Path) -> AsyncIterator[httpx.AsyncClient]:
    """Return a client of a server without a network on a data folder."""
    app = create_app(Settings(data=data))
    transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url=OWN_URL, timeout=PATIENCE_S) as client:
        yield client
    app.state.workspace.close()


class Served:
    """A server in a process of its own."""

    def __init__(self, data: Path, port: int = 0, *options: str) -> None:
        self.data = data
        self.options = options
        self._start(port)

    def _start(self, port: int) -> None:
        self.process = forked(["serve", "--port", str(port), "--data", str(self.data), *self.options])
        line = self.process.stdout.readline()
        assert "http://" in line, line + self.process.stdout.read()
        self.url = next(word for word in line.split() if word.startswith("http://"))

    @property
    def authority(self) -> str:
        return self.url.removeprefix("http://")

    @property
    def document(self) -> str:
        """The id of the document that the page shows first."""
        return REST.get(f"{self.url}/").headers["location"].rpartition("/")[2]

    @property
    def port(self) -> int:
        return int(self.url.rpartition(":")[2])

    def stop(self) -> None:
        """Kill the process, which leaves it no time to clean up."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate()

    def start_again(self) -> None:
        """Start another process with the same data on the same port."""
        self._start(self.port)


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """Start a real server on a free port."""
    server = Served(tmp_path_factory.mktemp("data"))
    yield server
    server.stop()
