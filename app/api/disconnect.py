"""Run work for a request, and stop it when the client disconnects."""

import asyncio
import contextlib
import math
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, ParamSpec, TypeVar

from fastapi import Request

from app.api.asker import workspace_of
from app.api.problems import ClientGoneError
from app.jobs.job_pool import Job, JobPool
from app.worker.stop import Stop

Answer = TypeVar("Answer")
P = ParamSpec("P")


async def quick_answer(request: Request, work: Callable[P, Answer], *arguments: P.args, **options: P.kwargs) -> Answer:
    """Return the result of a short job, which waits for no long one."""
    return await answer_of(request, workspace_of(request).lanes.quick, lambda _: work(*arguments, **options))


async def answer_of(
    request: Request | None, pool: JobPool, work: Callable[[Stop], Answer], begins_within_s: float | None = None
) -> Answer:
    """Return the result of a job; stop it if the client disconnects first, or if this is cancelled.

    Args:
        request: the client's request, whose body has been read; None if it came over a websocket.
        pool: the workers.
        work: the job.
        begins_within_s: how long the job may wait for its turn (s); None: as long as the client does.

    Raises:
        BusyError: the queue is full, or the wait was too long.
        ClientGoneError: the client has gone away.
        Exception: whatever the job raises.
    """
    job = pool.start(work)
    try:
        return await until(request, pool, job, job.future, begins_within_s)
    finally:
        job.stop()


async def until(
    request: Request | None, pool: JobPool, job: Job[Any], awaited: Future[Answer], begins_within_s: float | None
) -> Answer:
    """Return the awaited value of a job; arguments and errors are those of `answer_of`."""
    answer = asyncio.wrap_future(awaited)
    answer.add_done_callback(_heed)
    gone = asyncio.ensure_future(_disconnect(request))
    either: set[asyncio.Future[Any]] = {answer, gone}
    try:
        done, _ = await asyncio.wait(either, timeout=begins_within_s, return_when=asyncio.FIRST_COMPLETED)
        if not done and job.future.cancel():
            raise pool.busy()
        await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        if answer.done():
            return answer.result()
        raise ClientGoneError
    finally:
        gone.cancel()


def _heed(answer: asyncio.Future[Any]) -> None:
    """Retrieve an error that nobody waits for any more: asyncio would log it otherwise."""
    if not answer.cancelled():
        answer.exception()


async def _disconnect(request: Request | None) -> None:
    while request is None:
        await asyncio.sleep(math.inf)
    while True:
        message = await request.receive()
        if message["type"] == "http.disconnect":
            return


def waking(event: asyncio.Event) -> Callable[[], None]:
    """Return a function that sets an event of this loop from any thread."""
    loop = asyncio.get_running_loop()

    def wake() -> None:
        with contextlib.suppress(RuntimeError):  # the loop has ended: nobody waits for the event
            loop.call_soon_threadsafe(event.set)

    return wake
