"""The page's websocket: state of the document out, commands in.

Out: a ``document`` message at the start and whenever the drawing or its history changes, a ``plan`` message whenever
its plan changes, a ``playback`` message whenever the clock is set, and ten times a second while it runs. In: commands
(`app.api.messages`); an unknown command is answered with a ``problem`` and changes nothing.
"""

import asyncio
import contextlib
from collections.abc import Awaitable

from fastapi import APIRouter, WebSocket
from fastapi.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect

from app.api.body import parsed
from app.api.commands import command_of, dispatch
from app.api.disconnect import waking
from app.api.live_messages import problem_message
from app.api.serialization import SentState
from app.api.shared import is_shared, play, until_revoked
from app.jobs.limits import TooManyError
from app.open_document import OpenDocument
from app.workspace import Workspace
from planner.errors import FoldingError

router = APIRouter()

NOT_FOUND, TRY_AGAIN_LATER = 4404, 1013
_TICK_S = 0.1


@router.websocket("/api/documents/{document_id}/live")
async def live(websocket: WebSocket, document_id: str) -> None:
    """Send a page the document's changes and carry out its commands, until it disconnects."""
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
    with opened.in_use(waking(is_removed)):
        ways = [
            asyncio.create_task(_send_updates(websocket, opened)),
            asyncio.create_task(_listen(websocket, workspace, opened)),
            asyncio.create_task(_close_after(is_removed.wait(), websocket)),
            asyncio.create_task(_close_after(until_revoked(websocket, workspace.shares), websocket)),
        ]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for way in ways:
                way.cancel()
            await asyncio.gather(*ways, return_exceptions=True)


async def _send_updates(websocket: WebSocket, opened: OpenDocument) -> None:
    changed = asyncio.Event()
    played = opened.visitors if is_shared(websocket.scope) else opened.document
    unsubscribe = played.subscribe(waking(changed))
    sent = SentState(opened, played)
    try:
        while True:
            changed.clear()
            state = played.state
            for text in await run_in_threadpool(sent.updates, state):
                await websocket.send_text(text)
            timeout_s = _TICK_S if state.playback.is_playing else None
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(changed.wait(), timeout_s)
    except (WebSocketDisconnect, RuntimeError):
        return
    finally:
        unsubscribe()


async def _listen(websocket: WebSocket, workspace: Workspace, opened: OpenDocument) -> None:
    with contextlib.suppress(WebSocketDisconnect, KeyError):
        while True:
            text = await websocket.receive_text()
            try:
                command = command_of(parsed(text))
                if is_shared(websocket.scope):
                    play(command, opened.visitors)
                else:
                    await run_in_threadpool(dispatch, command, workspace, opened.document)
            except FoldingError as error:
                await websocket.send_json(problem_message(error))


async def _close_after(end: Awaitable[object], websocket: WebSocket) -> None:
    await end
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):
        await websocket.close(NOT_FOUND)
