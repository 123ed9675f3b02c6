"""The page's one channel: a websocket on which the document's state comes, and on which the page sends and asks.

Out: a ``document`` message at the start and whenever the drawing or its history changes, a ``plan`` message whenever
its plan changes, a ``playback`` message whenever the clock is set, and ten times a second while it runs. In: changes,
questions and commands (`app.api.document_messages`). What has a number, ``ask``, is answered with an ``answer`` of the
same number: the document's version that a change has made, or the answer to a question. The state that a change has
led to is sent before its answer. What is refused is answered with a ``problem`` (RFC 9457), and changes nothing.

Changes and commands are carried out in the order in which they come; questions wait for nothing but their lane.
"""

import asyncio
import contextlib
import logging
from collections.abc import Awaitable, Mapping
from typing import Any

from fastapi import APIRouter, WebSocket
from fastapi.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect

from app.api.body import LARGEST_BODY, SMALL_BODY, parsed, too_large
from app.api.commands import dispatch, play
from app.api.disconnect import answer_of, waking
from app.api.document_messages import SENT, AskCrease, AskPlaces, Drop, Question
from app.api.live_messages import SentState
from app.api.problems import FAILED, LookOnlyError, ProblemResponse, problem_of
from app.api.questions import work_of
from app.api.shared import is_shared, until_revoked
from app.jobs.limits import TooManyError
from app.open_document import OpenDocument
from app.workspace import Workspace
from planner.errors import FoldingError, RequestError

router = APIRouter()

NOT_FOUND, TRY_AGAIN_LATER = 4404, 1013
_TICK_S = 0.1

_log = logging.getLogger(__name__)


@router.websocket("/api/documents/{document_id}/live")
async def live(websocket: WebSocket, document_id: str) -> None:
    """Send a page the document's changes, and do what it sends, until it disconnects."""
    workspace: Workspace = websocket.app.state.workspace
    try:
        opened = await run_in_threadpool(workspace.opened, document_id)
    except TooManyError:
        await websocket.close(TRY_AGAIN_LATER)  # not accepted, so that the page waits longer each time
        return
    except FoldingError:
        await websocket.accept()
        await websocket.close(NOT_FOUND)
        return
    await websocket.accept()
    is_removed = asyncio.Event()
    page = _Page(websocket, workspace, opened)
    with opened.in_use(waking(is_removed)):
        ways = [
            asyncio.create_task(page.send()),
            asyncio.create_task(page.listen()),
            asyncio.create_task(_close_after(is_removed.wait(), websocket)),
            asyncio.create_task(_close_after(until_revoked(websocket, workspace.shares), websocket)),
        ]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for way in [*ways, *page.questions.values()]:
                way.cancel()
            await asyncio.gather(*ways, *page.questions.values(), return_exceptions=True)


class _Page:
    """A page at the other end of a websocket.

    Attributes:
        questions: what it waits for, by the number that it has given.
    """

    def __init__(self, websocket: WebSocket, workspace: Workspace, opened: OpenDocument) -> None:
        self._websocket = websocket
        self._workspace = workspace
        self._opened = opened
        self._is_shared = is_shared(websocket.scope)
        self._played = opened.visitors if self._is_shared else opened.document
        self._changed = asyncio.Event()
        self._answers: list[dict[str, Any]] = []
        self.questions: dict[int, asyncio.Task[None]] = {}

    async def send(self) -> None:
        """Send what is new: first the state, then the answers that there are by then."""
        unsubscribe = self._played.subscribe(waking(self._changed))
        sent = SentState(self._opened, self._played)
        try:
            while True:
                self._changed.clear()
                answers, self._answers = self._answers, []
                state = self._played.state
                for text in await run_in_threadpool(sent.updates, state):
                    await self._websocket.send_text(text)
                for answer in answers:
                    await self._websocket.send_json(answer)
                timeout_s = _TICK_S if state.playback.is_playing else None
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(self._changed.wait(), timeout_s)
        except (WebSocketDisconnect, RuntimeError):
            return
        finally:
            unsubscribe()

    async def listen(self) -> None:
        """Do what the page sends."""
        with contextlib.suppress(WebSocketDisconnect, KeyError):
            while True:
                await self._do(await self._websocket.receive_text())

    async def _do(self, text: str) -> None:
        number: int | None = None
        try:
            is_small = len(text) <= SMALL_BODY
            data = _object(text) if is_small else await run_in_threadpool(_object, text)
            number = _number(data)
            if len(text.encode()) > LARGEST_BODY:
                raise too_large(LARGEST_BODY)
            sent = SENT.read(data) if is_small else await run_in_threadpool(SENT.read, data)
            if isinstance(sent, Drop):
                question = self.questions.get(sent.question)
                if question is not None:
                    question.cancel()
            elif isinstance(sent, Question):
                if number is None or number in self.questions:
                    raise RequestError("ask", "is missing, or the number of a question that is being answered")
                self.questions[number] = asyncio.create_task(self._answer(number, sent))
            elif self._is_shared:
                play(sent, self._opened.visitors)
            else:
                state = await run_in_threadpool(dispatch, sent, self._workspace, self._opened.document)
                self._say("answer", number, {"version": state.version, "result": None})
        except Exception as error:
            self._refuse(number, error)

    async def _answer(self, number: int, asked: Question) -> None:
        try:
            if self._is_shared and isinstance(asked, AskCrease | AskPlaces):
                raise LookOnlyError
            work = work_of(asked, self._workspace, self._opened)
            result = await answer_of(None, *work)
            self._say("answer", number, {"version": self._opened.document.state.version, "result": result})
        except Exception as error:
            self._refuse(number, error)
        finally:
            del self.questions[number]

    def _say(self, kind: str, number: int | None, answer: Mapping[str, Any]) -> None:
        """Answer what has a number, and tell of any problem."""
        if number is not None or kind == "problem":
            self._answers.append({"kind": kind, "ask": number, **answer})
            self._changed.set()

    def _refuse(self, number: int | None, error: Exception) -> None:
        problem = problem_of(error)
        if problem is None:
            _log.error("the page's %s failed", self._opened.id, exc_info=error)
            problem = ProblemResponse(500, FAILED)
        self._say("problem", number, problem.problem)


def _object(text: str) -> dict[str, Any]:
    data = parsed(text)
    if not isinstance(data, dict):
        raise RequestError("body", "the body is not a JSON object")
    return data


def _number(data: dict[str, Any]) -> int | None:
    """Remove the number from a page's message and return it; None without a number."""
    number = data.pop("ask", None)
    if number is not None and (type(number) is not int or number < 0):
        raise RequestError("ask", "should be a whole number that is not negative")
    return number


async def _close_after(end: Awaitable[object], websocket: WebSocket) -> None:
    await end
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):
        await websocket.close(NOT_FOUND)
