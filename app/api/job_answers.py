"""The shapes of answers about jobs."""

from datetime import UTC, datetime
from typing import Any

from pydantic import BaseModel

from app.store.job_repository import JobStatus, StoredJob


class JobEntry(BaseModel):
    """A job in the list: its status, the share that is done, what is being done or why it failed; times in UTC."""

    id: str
    kind: str
    status: JobStatus
    progress: float
    message: str
    created: str
    started: str | None
    ended: str | None


class JobAnswer(JobEntry):
    """A job with its result; null unless it is done."""

    result: Any


class JobsAnswer(BaseModel):
    """Jobs, newest first, and the value of `before` that gives the next older ones; null at the end."""

    jobs: list[JobEntry]
    before: str | None


def job_entry(job: StoredJob) -> dict[str, Any]:
    """Return a job without its result."""
    return {
        "id": job.id,
        "kind": job.kind,
        "status": job.status,
        "progress": job.progress,
        "message": job.message,
        "created": _utc(job.created_s),
        "started": _utc(job.started_s),
        "ended": _utc(job.ended_s),
    }


def _utc(at_s: float | None) -> str | None:
    """Return a time as in RFC 3339."""
    if at_s is None:
        return None
    return datetime.fromtimestamp(at_s, UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
