"""Waits for work in another thread as long as somebody waits for the answer."""

import asyncio
from typing import Any, TypeVar

from fastapi import Request

from app.api.problems import ClientGoneError
from app.job_pool import Job

Answer = TypeVar("Answer")


async def answer_of(request: Request, job: Job[Answer]) -> Answer:
    """The job's answer; when the client goes away first, the job is stopped.

    The request's body must have been read. Raises what the job raises, and `ClientGoneError`.
    """
    answer = asyncio.wrap_future(job.future)
    gone = asyncio.ensure_future(_disconnect(request))
    either: set[asyncio.Future[Any]] = {answer, gone}
    try:
        await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        if answer.done():
            return answer.result()
        raise ClientGoneError("the client went away")
    finally:
        gone.cancel()
        job.stop()


async def _disconnect(request: Request) -> None:
    while True:
        message = await request.receive()
        if message["type"] == "http.disconnect":
            return
