"""The tables of the database; `migrations` has the steps that lead to them from every version before."""

from sqlalchemy import Index, Text
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column


class Table(DeclarativeBase):
    """A table of the database."""


class JobRow(Table):
    """A job: its request, its progress and its result.

    `number` grows from job to job. Times are seconds since the epoch. `body` and `result` are JSON. `begun` counts how
    often the job was started, since a job that ends the server must not be started anew for ever.
    """

    __tablename__ = "jobs"
    __table_args__ = (Index("jobs_by_status", "status"), {"sqlite_autoincrement": True})

    number: Mapped[int] = mapped_column(primary_key=True)
    id: Mapped[str] = mapped_column(unique=True)
    kind: Mapped[str]
    client: Mapped[str]
    status: Mapped[str]
    progress: Mapped[float]
    message: Mapped[str] = mapped_column(Text)
    created_s: Mapped[float]
    started_s: Mapped[float | None]
    ended_s: Mapped[float | None]
    begun: Mapped[int]
    revision: Mapped[int]
    body: Mapped[str] = mapped_column(Text, deferred=True)
    result: Mapped[str | None] = mapped_column(Text, deferred=True)
