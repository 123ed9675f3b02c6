"""Routes of jobs: asking for one of each kind, looking how far it is, following it, cancelling it."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import suppress
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.responses import JSONResponse

from app.api.asker import client_of, workspace_of
from app.api.body import JsonBody, read_object
from app.api.described import answering, problems, taking
from app.api.disconnect import waking
from app.api.job_answers import STREAM, JobAnswer, JobsAnswer, job_entry
from app.api.request_parsing import within_request
from app.job_kinds.kinds import BY_JSON
from app.jobs.job_desk import JobDesk
from app.jobs.job_kind import AnyKind
from app.store.job_repository import StoredJob

router = APIRouter(tags=["jobs"])

LISTED_MAX = 100
_QUIET_S = 0.1
"""Least time between two events of a job (s)."""

_LOOK_S = 2.0
"""Longest time without a look at a job: one that another server does tells nothing (s)."""

LastEventId = Annotated[str | None, Header(alias="last-event-id")]


async def begun(request: Request, kind: AnyKind, data: dict[str, Any]) -> JSONResponse:
    """Return the answer to a request that starts a job: 202, and where it is."""
    jobs = workspace_of(request).jobs
    job = await run_in_threadpool(jobs.submit, kind, data, client_of(request), within_request)
    location = f"{request.scope.get('root_path', '')}/api/jobs/{job.id}"
    return JSONResponse({**job_entry(job), "result": None}, 202, headers={"location": location})


def _starting(kind: AnyKind) -> Callable[[Request], Awaitable[JSONResponse]]:
    async def start(request: Request) -> JSONResponse:
        return await begun(request, kind, await read_object(request, most=kind.largest_body))

    return start


for _kind in BY_JSON:
    router.add_api_route(
        _kind.route,
        _starting(_kind),
        methods=["POST"],
        name=f"start_{_kind.name}",
        description=f"{_kind.does} Answers at once; `Location` is the job's path.",
        status_code=202,
        responses=answering(JobAnswer, 404, 409, 413, 422, 429, 503, status=202),
        openapi_extra=taking(JsonBody(_kind.body, _kind.example)),
    )


@router.get("/api/jobs", responses=answering(JobsAnswer, 404, 422))
async def list_jobs(
    request: Request, limit: Annotated[int, Query(ge=1, le=LISTED_MAX)] = 20, before: str | None = None
) -> JSONResponse:
    """Return the newest jobs, or the newest of those older than the job `before`.

    Searches for proposals that were cancelled are left out.
    """
    found = await run_in_threadpool(workspace_of(request).jobs.newest, limit, before)
    return JSONResponse(
        {"jobs": [job_entry(job) for job in found], "before": found[-1].id if len(found) == limit else None}
    )


@router.get("/api/jobs/{job_id}", responses=answering(JobAnswer, 404))
async def read_job(request: Request, job_id: str) -> JSONResponse:
    """Return how far a job is, and its result once it is done."""
    return JSONResponse(await run_in_threadpool(_answer, workspace_of(request).jobs, job_id))


@router.post("/api/jobs/{job_id}/cancel", responses=answering(JobAnswer, 404, 409))
async def cancel_job(request: Request, job_id: str) -> JSONResponse:
    """Cancel a job unless it has ended, and return it; its process is killed."""
    jobs = workspace_of(request).jobs
    await run_in_threadpool(jobs.cancel, job_id)
    return JSONResponse(await run_in_threadpool(_answer, jobs, job_id))


async def _known(request: Request, job_id: str) -> StoredJob:
    """Return the job; an unknown one is a problem before the stream begins."""
    return await run_in_threadpool(workspace_of(request).jobs.job, job_id)


@router.get("/api/jobs/{job_id}/events", response_class=EventSourceResponse, responses={200: STREAM, **problems(404)})
async def follow_job(
    request: Request, job: Annotated[StoredJob, Depends(_known)], last_event_id: LastEventId = None
) -> AsyncIterator[ServerSentEvent]:
    """Send a job as an event `progress` whenever it changes, and as an event `end`, with its result, when it ends.

    What a job finds on its way, as proposals are, is sent as an event `found`, as it is in the result, when it is
    found. A client that comes back with `Last-Event-ID` is sent what has changed since, and all that was found.
    Comments keep the connection open.
    """
    jobs, changed, sent, yielded = workspace_of(request).jobs, asyncio.Event(), last_event_id, 0
    found = jobs.found(job.id)
    unsubscribe = jobs.subscribe(job.id, waking(changed))
    try:
        while True:
            changed.clear()
            now = await run_in_threadpool(jobs.job, job.id)
            while yielded < len(found):
                yielded += 1
                yield ServerSentEvent(event="found", data=found[yielded - 1])
            if not now.is_open:
                answer = await run_in_threadpool(_answer, jobs, job.id)
                yield ServerSentEvent(event="end", id=str(now.revision), data=answer)
                return
            if sent != str(now.revision):
                sent = str(now.revision)
                yield ServerSentEvent(event="progress", id=sent, data=job_entry(now))
                await asyncio.sleep(_QUIET_S)
            with suppress(TimeoutError):
                async with asyncio.timeout(_LOOK_S):
                    await changed.wait()
    finally:
        unsubscribe()


def _answer(jobs: JobDesk, job_id: str) -> dict[str, Any]:
    job = jobs.job(job_id)
    return {**job_entry(job), "result": None if job.is_open else jobs.result(job_id)}
