"""The tables of the database; `migrations` has the steps that lead to them."""

from sqlalchemy import BigInteger, ForeignKey, Index, LargeBinary, Text, delete, select
from sqlalchemy.orm import DeclarativeBase, Mapped, Session, mapped_column


class Table(DeclarativeBase):
    """A table of the database."""


class JobRow(Table):
    """A job: its request, its progress and its result.

    `number` grows from job to job. Times are seconds since the epoch. `body` and `result` are JSON. `begun` counts how
    often the job was started, since a job that ends the server must not be started anew for ever. `about` is the title
    of the garment or study that it is about, and `server` the number of the server that does it (`Database.number`).
    """

    __tablename__ = "jobs"
    __table_args__ = (Index("jobs_by_status", "status"), {"sqlite_autoincrement": True})

    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=True)
    id: Mapped[str] = mapped_column(unique=True)
    kind: Mapped[str]
    client: Mapped[str]
    about: Mapped[str] = mapped_column(Text, server_default="")
    server: Mapped[int] = mapped_column(BigInteger, server_default="0")
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


class DocumentRow(Table):
    """A document without its drawings.

    Its steps are those numbered from `first` on; `now` is the current one, those after it are what redo restores.
    `revision` counts the commits, so that a server notices that another one was quicker. `changed_at` is UTC, as in RFC
    3339, and `opened_s` seconds since the epoch. `preview` is the drawing that a gesture in progress has led to, and
    `start` the world state from which the drawing is planned, both as JSON. A document
    that cannot be read has no steps: `problem` says why.
    """

    __tablename__ = "documents"
    __table_args__ = (Index("documents_by_change", "changed_at", "id"),)

    id: Mapped[str] = mapped_column(primary_key=True)
    format: Mapped[int]
    revision: Mapped[int]
    version: Mapped[int]
    changed_at: Mapped[str]
    opened_s: Mapped[float | None]
    title: Mapped[str]
    name: Mapped[str]
    first: Mapped[int]
    now: Mapped[int]
    problem: Mapped[str | None] = mapped_column(Text)
    start: Mapped[str | None] = mapped_column(Text)
    preview_version: Mapped[int | None]
    preview_label: Mapped[str | None]
    preview: Mapped[str | None] = mapped_column(Text)


class StepRow(Table):
    """A drawing of a document, as JSON, and the step that led to it; `changed_at` is empty where it is not known."""

    __tablename__ = "document_steps"

    document_id: Mapped[str] = mapped_column(ForeignKey("documents.id", ondelete="CASCADE"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    label: Mapped[str] = mapped_column(Text)
    changed_at: Mapped[str]
    drawing: Mapped[str] = mapped_column(Text)


class GarmentRow(Table):
    """A garment of the user's own, as JSON."""

    __tablename__ = "garments"

    name: Mapped[str] = mapped_column(primary_key=True)
    content: Mapped[str] = mapped_column(Text)


class SizedRow(Table):
    """A row of a table of which only the newest are kept: its content and its size (bytes); `number` grows."""

    __abstract__ = True
    __table_args__ = ({"sqlite_autoincrement": True},)

    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=True)
    id: Mapped[str] = mapped_column(unique=True)
    size: Mapped[int]
    content: Mapped[bytes] = mapped_column(LargeBinary)


class PlanRow(SizedRow):
    """A plan as compressed JSON."""

    __tablename__ = "plans"


class TraceRow(SizedRow):
    """The trace of a rehearsed run, packed (`app.rehearsal.trace`)."""

    __tablename__ = "traces"


class ShareRow(Table):
    """A link to look at a document: the hash of its token, and when it was made (s since the epoch)."""

    __tablename__ = "shares"

    hash: Mapped[str] = mapped_column(primary_key=True)
    document_id: Mapped[str] = mapped_column(ForeignKey("documents.id", ondelete="CASCADE"), index=True)
    created_s: Mapped[float]


class RobotRow(Table):
    """A robot of the user's own: its folder as an archive, and a digest of its files (`app.store.robot_repository`).

    A robot that was removed keeps its row without content, so that other servers on the database remove theirs.
    """

    __tablename__ = "robots"

    name: Mapped[str] = mapped_column(primary_key=True)
    digest: Mapped[str]
    content: Mapped[bytes | None] = mapped_column(LargeBinary, deferred=True)


class StudyRow(Table):
    """A study that is done, as JSON, and when (s since the epoch)."""

    __tablename__ = "studies"

    id: Mapped[str] = mapped_column(primary_key=True)
    title: Mapped[str] = mapped_column(Text)
    done_s: Mapped[float]
    content: Mapped[str] = mapped_column(Text, deferred=True)


class StudyFileRow(Table):
    """A file of a study that is done: its table or its report."""

    __tablename__ = "study_files"

    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id", ondelete="CASCADE"), primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    content: Mapped[bytes] = mapped_column(LargeBinary)


def drop_oldest(session: Session, table: type[SizedRow], most: int, most_bytes: int) -> None:
    """Drop the oldest rows of a table beyond a number of rows, and beyond their size in all (bytes)."""
    kept, total = 0, 0
    for number, size in session.execute(select(table.number, table.size).order_by(table.number.desc())):
        kept, total = kept + 1, total + size
        if kept > most or total > most_bytes:
            session.execute(delete(table).where(table.number <= number))
            return
