"""The shapes of answers about jobs."""

from datetime import UTC, datetime
from typing import Any

from pydantic import BaseModel, ConfigDict

from app.api.described import event_stream
from app.store.job_repository import JobStatus, StoredJob


class JobEntry(BaseModel):
    """A job in the list: its status, the share that is done, what is being done or why it failed; times in UTC.

    `about` is the title of the garment or study that it is about, empty where it is about none.
    """

    id: str
    kind: str
    about: str
    status: JobStatus
    progress: float
    message: str
    created: str
    started: str | None
    ended: str | None


class JobAnswer(JobEntry):
    """A job with its result; null unless it is done."""

    result: Any


class JobFound(BaseModel):
    """What a job found on its way, as it is in the job's result."""

    model_config = ConfigDict(extra="allow")


EVENTS = (JobEntry, JobFound, JobAnswer)

_BEGUN: dict[str, Any] = {
    "id": "0123456789abcdef0123456789abcdef",
    "kind": "placements",
    "about": "Hand towel",
    "status": "running",
    "progress": 0.5,
    "message": "6 of 12 places",
    "created": "2026-01-31T12:00:00.000Z",
    "started": "2026-01-31T12:00:00.010Z",
    "ended": None,
}
_ENDED = {"status": "done", "progress": 1.0, "message": "", "ended": "2026-01-31T12:00:02.500Z", "result": {}}
STREAM = event_stream(
    {
        "progress": (JobEntry, _BEGUN),
        "found": (JobFound, {"size_m": [0.25, 0.3]}),
        "end": (JobAnswer, {**_BEGUN, **_ENDED}),
    },
    "The job whenever it changes, and at its end with its result",
)


class JobsAnswer(BaseModel):
    """Jobs, newest first, and the value of `before` that gives the next older ones; null at the end."""

    jobs: list[JobEntry]
    before: str | None


def job_entry(job: StoredJob) -> dict[str, Any]:
    """Return a job without its result."""
    return {
        "id": job.id,
        "kind": job.kind,
        "about": job.about,
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
